"""When a camera asks where the robot is, and what it makes of the answers."""

from __future__ import annotations

from math import pi

import pytest
from pydantic import ValidationError

from hilbed.sensors.camera import CameraSpec
from hilbed.sensors.exposure import Exposure, Moment, still
from hilbed.types import Pose, Truth
from tests.sensors.cameras import ORIGIN, Bench

MS = 1_000_000


def test_between_moments_things_move_in_proportion_and_beyond_them_on() -> None:
    path = (
        Moment(0, Pose(0.0, 0.0, 3.0), 0.0),
        Moment(10, Pose(1.0, 0.0, -3.0), 1.0),
        Moment(20, Pose(1.0, 2.0, -3.0), 1.0),
    )
    exposure = Exposure(10, path)
    turned = 2 * pi - 6.0
    assert exposure.at(10) == path[1]
    assert exposure.at(5).pose.x == pytest.approx(0.5)
    assert abs(exposure.at(5).pose.yaw) == pytest.approx(pi)
    assert exposure.at(5).pan == pytest.approx(0.5)
    assert exposure.at(25).pose == pytest.approx((1.0, 3.0, -3.0))
    assert exposure.at(-10).pose == pytest.approx((-1.0, 0.0, 3.0 - turned))
    assert still(7, ORIGIN, 0.3).at(99) == Moment(99, ORIGIN, 0.3)


def dues(block: dict[str, float], step: int, until: int) -> tuple[list[int], Bench]:
    """Drives along x at 1 m/s with `step` ns a tick; returns when the camera asked."""
    bench, asked = Bench(block), []
    for t in range(0, until, step):
        if bench.camera.due <= t:
            asked.append(t)
            bench.camera.sample(Truth(t, Pose(1e-9 * t, 0.0, 0.0)))
    return asked, bench


def test_without_exposure_it_asks_once_a_frame() -> None:
    asked, _ = dues({}, MS, 350 * MS)
    assert asked == [0, 100 * MS, 200 * MS, 300 * MS]


def test_an_exposure_is_known_at_its_begin_middle_and_end_and_keeps_the_time_of_its_middle() -> None:
    asked, bench = dues({"exposure": 0.01, "readout": 0.006}, MS, 230 * MS)
    assert asked == [t * MS for t in (0, 8, 92, 100, 108, 192, 200, 208)]
    assert [round(eye.x, 9) for eye in bench.ideal.seen] == [0.0, 0.1, 0.2]
    readings = bench.camera.read(250 * MS)
    assert sorted({(r.t, r.delivered) for r in readings}) == [(t * MS, (t + 50) * MS) for t in (0, 100, 200)]


def test_an_exposure_shorter_than_a_tick_still_makes_one_frame_a_period() -> None:
    asked, bench = dues({"exposure": 0.0004}, MS, 350 * MS)
    assert asked == [t * MS for t in (0, 1, 100, 101, 200, 201, 300, 301)]
    bench.camera.flush()
    assert [s.t for s in bench.notes.snapshots] == [0, 100 * MS, 200 * MS, 300 * MS]


def test_a_blind_camera_exposes_nothing_and_goes_on() -> None:
    bench = Bench({"exposure": 0.01})
    bench.effects.blind = True
    bench.camera.sample(Truth(0, ORIGIN))
    bench.camera.sample(Truth(5 * MS, ORIGIN))
    assert bench.camera.due == 95 * MS
    bench.effects.blind = False
    for t in (95, 100, 105):
        bench.camera.sample(Truth(t * MS, ORIGIN))
    assert bench.camera.read(150 * MS)
    assert [s.t for s in bench.notes.snapshots] == [100 * MS]


@pytest.mark.parametrize(
    ("block", "word"),
    [
        ({"exposure": 0.02, "rate": 60.0}, "a frame only 0.0166667 s"),
        ({"exposure": 0.02, "latency": 0.005}, "latency 0.005 s counts from the middle"),
        ({"exposure": -0.1}, "greater than or equal to 0"),
        ({"k1": -0.5}, "folds the image"),
        ({"k1": float("nan")}, "k1"),
        ({"fy": 300.0}, "fy needs fx"),
        ({"fx": 1e-3, "cx": 0.0, "k1": 1e-9}, "off the middle"),
        ({"tilt_deg": 89.0}, "tilt_deg"),
        ({"bits": 0}, "bits"),
        ({"bits": 16}, "bits"),
        ({"gain": 0.0}, "gain"),
        ({"vignetting": 1.5}, "vignetting"),
    ],
)
def test_a_camera_that_cannot_be_is_told_why(block: dict[str, float], word: str) -> None:
    with pytest.raises(ValidationError, match=word):
        CameraSpec.model_validate(block)
