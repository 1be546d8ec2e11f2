from __future__ import annotations

from math import cos, hypot, pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from hilbed.angles import wrap
from hilbed.control.legs import LegsSpec
from hilbed.types import Pose

REFERENCE = LegsSpec().build()
NS = 10**9


def printed(t: float) -> Pose:
    """Equations (3.1) to (3.3) of Bui & Duong (2022)."""
    if t < 20:
        return Pose(-20 + t, 4.0, 0.0)
    if t < 30:
        a = 2 * pi / 20 * (t - 20)
        return Pose(4 * sin(a), 4 * cos(a), -a)
    return Pose(30 - t, -4.0, -pi)


@given(st.integers(0, 50 * NS))
def test_the_path_is_the_printed_one(t: int) -> None:
    pose, expected = REFERENCE.at(t).pose, printed(t * 1e-9)
    assert hypot(pose.x - expected.x, pose.y - expected.y) < 1e-9
    assert wrap(pose.yaw - expected.yaw) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("t", "v", "w"),
    [
        (0, 1.0, 0.0),
        (20 * NS - 1, 1.0, 0.0),
        (20 * NS, 0.4 * pi, -0.1 * pi),
        (30 * NS - 1, 0.4 * pi, -0.1 * pi),
        (30 * NS, 1.0, 0.0),
        (50 * NS - 1, 1.0, 0.0),
        (50 * NS, 0.0, 0.0),
    ],
)
def test_speeds_jump_at_20_and_30_s_and_are_those_of_what_comes(t: int, v: float, w: float) -> None:
    point = REFERENCE.at(t)
    assert (point.v, point.w) == pytest.approx((v, w), abs=1e-12)


@given(st.integers(0, 49 * NS).filter(lambda t: min(abs(t - 20 * NS), abs(t - 30 * NS)) > 10**6))
def test_speed_and_turn_rate_are_the_derivatives(t: int) -> None:
    a, b, h = REFERENCE.at(t).pose, REFERENCE.at(t + 1000).pose, 1e-6
    point = REFERENCE.at(t)
    assert ((b.x - a.x) / h, (b.y - a.y) / h) == pytest.approx(
        (point.v * cos(a.yaw), point.v * sin(a.yaw)), abs=1e-4
    )
    assert wrap(b.yaw - a.yaw) / h == pytest.approx(point.w, abs=1e-4)


def test_after_the_last_leg_it_stands_at_the_end() -> None:
    assert REFERENCE.at(80 * NS).pose == pytest.approx((-20.0, -4.0, pi), abs=1e-9)
    box = REFERENCE.extent()
    assert (box.x_min, box.y_min, box.x_max, box.y_max) == pytest.approx((-20, -4, 4, 4), abs=1e-9)


@pytest.mark.parametrize(
    "bad", [{"legs": []}, {"legs": [{"length": -1, "duration": 1}]}, {"legs": [{"length": 1}]}]
)
def test_bad_legs_are_refused(bad: dict[str, object]) -> None:
    with pytest.raises(ValidationError):
        LegsSpec.model_validate(bad)
