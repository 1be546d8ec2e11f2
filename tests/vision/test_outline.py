"""What part of a beacon a frame shows, against brute force and a scene where it can be worked out."""

from __future__ import annotations

from math import pi

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed.cost import Cost
from hilbed.scene import BeaconSpec
from hilbed.sensors.camera import CameraSpec
from hilbed.sensors.exposure import still
from hilbed.sensors.eye import Setting
from hilbed.sensors.imager import open_imager
from hilbed.types import Pose
from hilbed.vision.outline import centres_inside
from hilbed.vision.seams import BeaconTruth
from tests.vision.scenes import beacon

TALL = CameraSpec(height=480)
corner = st.floats(-20.0, 20.0).map(lambda x: x + 0.0123)


@given(st.lists(st.tuples(corner, corner), min_size=3, max_size=9))
def test_pixel_centres_are_counted_as_one_by_one(corners: list[tuple[float, float]]) -> None:
    hull = cv2.convexHull(np.array(corners, np.float32))
    depths = [
        cv2.pointPolygonTest(hull, (float(x), float(y)), True) for x in range(-22, 23) for y in range(-22, 23)
    ]
    inside, doubtful = sum(d > 1e-4 for d in depths), sum(abs(d) <= 1e-4 for d in depths)
    assert inside <= centres_inside(hull.reshape(-1, 2).astype(float)) <= inside + doubtful


def truths(
    beacons: tuple[BeaconSpec, ...], spec: CameraSpec = TALL, yaw: float = 0.0
) -> tuple[BeaconTruth, ...]:
    imager = open_imager(spec, Setting(beacons), Cost())
    truth = imager.truth(still(0, Pose(0.0, 0.0, yaw)), beacons)
    imager.close()
    return truth.beacons


@pytest.mark.parametrize("shape", ["cone", "cylinder", "sphere", "board", "box"])
@pytest.mark.parametrize("lens", [{}, {"k1": -0.1, "k2": 0.01}, {"tilt_deg": 5.0}])
def test_a_beacon_that_nothing_hides_is_seen_whole(shape: str, lens: dict[str, float]) -> None:
    spec = CameraSpec.model_validate({"height": 480, **lens})
    for distance in (1.2, 3.0, 6.0):
        (one,) = truths((beacon(0.2, distance, shape=shape),), spec)  # type: ignore[arg-type]
        assert one.visible == pytest.approx(1.0, abs=0.04)


def test_a_board_half_behind_another_is_half_seen() -> None:
    far = BeaconSpec(at=(4.0, 0.0), shape="board", foot_radius=0.4, height=0.6)
    near = BeaconSpec(at=(2.0, 0.2), shape="board", foot_radius=0.2, height=0.9, colour="blue")
    first, second = truths((far, near))
    assert first.visible == pytest.approx(0.5, abs=0.04)
    assert second.visible == 1.0
    assert first.box is not None
    assert first.box[0] == pytest.approx(TALL.lens.column(0.0), abs=1.5)  # its left half is hidden


def test_what_is_out_of_the_image_is_not_seen_and_what_is_cut_off_in_part() -> None:
    board = BeaconSpec(at=(4.0, 0.0), shape="board", foot_radius=0.2, height=0.6, facing=pi)
    for yaw, visible in ((0.0, 1.0), (pi / 4, 0.5), (1.2, 0.0), (pi, 0.0)):
        (one,) = truths((board,), yaw=yaw)
        assert one.visible == pytest.approx(visible, abs=0.05)
        assert (one.box is None) == (visible == 0.0)
    (one,) = truths((board,), CameraSpec())
    assert one.visible == pytest.approx(1.0, abs=0.02)
    (near,) = truths((board.model_copy(update={"at": (1.0, 0.0)}),), CameraSpec())
    assert near.visible == pytest.approx(
        64 / (320 * 0.6), abs=0.02
    )  # rows that the image has of those it takes
