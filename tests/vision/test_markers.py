"""Markers on rendered beacons, and on images that OpenCV projects, without the renderer."""

from __future__ import annotations

from math import cos, pi, sin

import cv2
import numpy as np
import pytest

from hilbed.cost import Cost
from hilbed.scene import BeaconSpec
from hilbed.types import Array, Image
from hilbed.vision.detectors import MarkersSpec, identified, make_detector
from hilbed.vision.lens import Lens
from hilbed.vision.render import BulletRenderer, Scenery
from hilbed.vision.seams import Detection, Shot, Viewpoint

LENS = Lens.of_fov(1280, 160, pi / 2)
ORIGIN = Viewpoint(0.0, 0.0, 0.3, 0.0)


def carrier(azimuth: float, distance: float, marker: int, **block: object) -> BeaconSpec:
    at = (distance * cos(azimuth), distance * sin(azimuth))
    shape = {"shape": "board", "foot_radius": 0.15, "height": 0.45}
    return BeaconSpec.model_validate({"at": at, "marker": marker, **shape, **block})


def seen(beacons: list[BeaconSpec], anonymous: bool = False) -> list[Detection]:
    renderer = BulletRenderer(LENS, Scenery(beacons), Cost())
    image = renderer.render(ORIGIN, 0)
    renderer.close()
    return make_detector(MarkersSpec(), LENS, beacons, anonymous).detect(Shot(image, 0, LENS))


def errors(shape: str, turned: float) -> tuple[Array, Array, int]:
    """Returns errors and stated standard deviations (rad), and how many beacons there were."""
    rng = np.random.default_rng(3)
    found, stated = [], []
    for _ in range(40):
        azimuths = np.linspace(-0.6, 0.6, 4) + rng.uniform(-0.05, 0.05, 4)
        turns, distances = rng.uniform(-turned, turned, 4), rng.uniform(1.5, 6.0, 4)
        beacons = [
            carrier(a, d, k, shape=shape, facing=a + pi + turn)
            for k, (a, d, turn) in enumerate(zip(azimuths, distances, turns, strict=True))
        ]
        for one in seen(beacons):
            assert one.beacon is not None
            found.append(one.azimuth - azimuths[one.beacon])
            stated.append(one.std)
    return np.array(found), np.array(stated), 160


def test_azimuths_of_boards_are_within_a_fifth_of_a_pixel_and_say_so() -> None:
    error, stated, count = errors("board", 0.7)
    pixels = error * LENS.fx
    assert error.size >= 0.95 * count
    assert abs(pixels.mean()) <= 0.06
    assert pixels.std() <= 0.2
    assert 0.7 <= np.sqrt(np.mean((error / stated) ** 2)) <= 1.3


@pytest.mark.parametrize(("shape", "turned", "recall"), [("box", 0.8, 0.9), ("cylinder", 0.3, 0.5)])
def test_what_has_no_marker_on_its_axis_is_coarser_and_says_so(
    shape: str, turned: float, recall: float
) -> None:
    error, stated, count = errors(shape, turned)
    assert error.size >= recall * count
    assert np.median(stated) * LENS.fx > 0.5
    assert 0.4 <= np.sqrt(np.mean((error / stated) ** 2)) <= 1.6


def test_identity_is_that_of_the_one_beacon_with_the_marker() -> None:
    beacons = [carrier(0.3, 2.0, 7), carrier(0.0, 2.0, 9), carrier(-0.3, 2.0, 9)]
    assert [one.beacon for one in seen(beacons)] == [0, None, None]
    assert identified(MarkersSpec(), beacons) == [0, None, None]
    assert [one.beacon for one in seen(beacons, anonymous=True)] == [None] * 3


def test_dictionaries_are_those_of_the_beacons() -> None:
    beacons = [carrier(0.2, 1.5, 3, dictionary="APRILTAG_36h11"), carrier(-0.2, 1.5, 3)]
    assert [one.beacon for one in seen(beacons)] == [0, 1]


def projected(lens: Lens, number: int, corners: Array) -> Image:
    """Returns an image of a marker whose corners (4, 2) are at these pixels, smooth as a real camera's."""
    dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50)
    cells = np.full((8 * 40, 8 * 40), 255, np.uint8)
    cells[40:-40, 40:-40] = cv2.aruco.generateImageMarker(dictionary, number, 240)
    fine = 8
    inner = np.array([(39.5, 39.5), (279.5, 39.5), (279.5, 279.5), (39.5, 279.5)], np.float32)
    there = (fine * (corners + 0.5) - 0.5).astype(np.float32)
    turn = cv2.getPerspectiveTransform(inner, there)
    size = (fine * lens.width, fine * lens.height)
    large = cv2.warpPerspective(cells, turn, size, borderMode=cv2.BORDER_CONSTANT, borderValue=200)
    small = cv2.resize(large, (lens.width, lens.height), interpolation=cv2.INTER_AREA)
    return np.asarray(cv2.cvtColor(small, cv2.COLOR_GRAY2RGB), np.uint8)


@pytest.mark.parametrize("turned", [0.0, 0.5, -0.9])
@pytest.mark.parametrize("distortion", [(0.0, 0.0), (-0.15, 0.03)])
def test_the_middle_is_that_of_the_square_in_space_however_it_is_seen(
    turned: float, distortion: tuple[float, float]
) -> None:
    """Against cv2.projectPoints: the mean of the corners' columns would be up to 1.7 pixels off."""
    lens = Lens(640, 480, 500.0, 500.0, 319.5, 239.5, k1=distortion[0], k2=distortion[1])
    square = np.array([(-0.1, -0.1, 0.0), (0.1, -0.1, 0.0), (0.1, 0.1, 0.0), (-0.1, 0.1, 0.0)])
    points = np.vstack((square, np.zeros(3)))
    pixels, _ = cv2.projectPoints(
        points, np.array([0.1, turned, 0.0]), np.array([0.25, 0.05, 0.8]), lens.matrix, lens.distortion
    )
    *corners, middle = pixels.reshape(-1, 2)
    shot = Shot(projected(lens, 5, np.array(corners)), 0, lens)
    (found,) = make_detector(MarkersSpec(), lens, None).detect(shot)
    assert found.beacon == 5
    assert found.column == pytest.approx(middle[0], abs=0.1)
    assert found.row == pytest.approx(middle[1], abs=0.1)
    assert found.azimuth == pytest.approx(-np.arctan2(0.25, 0.8), abs=0.1 / 500.0)


def test_a_marker_that_nobody_carries_is_left_out() -> None:
    lens = Lens.of_fov(320, 240, 1.0)
    image = projected(lens, 5, np.array([(100, 100), (160, 100), (160, 160), (100, 160)], float))
    shot = Shot(image, 0, lens)
    assert make_detector(MarkersSpec(), lens, [carrier(0.0, 2.0, 4)]).detect(shot) == []
    assert make_detector(MarkersSpec(), lens, []).detect(shot) == []
    assert [one.beacon for one in make_detector(MarkersSpec(), lens, None).detect(shot)] == [5]
