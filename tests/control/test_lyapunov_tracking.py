from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed.control.legs import LegsSpec
from hilbed.control.lqr import body_error
from hilbed.control.lyapunov_spec import LyapunovTrackingSpec
from hilbed.control.lyapunov_tracking import Gains, LyapunovTracking, tracking_twist
from hilbed.plant.kinematics import exact
from hilbed.types import Estimate, Pose

GAINS = Gains(0.5, 0.4, 0.3)
errors = st.tuples(st.floats(-3, 3), st.floats(-3, 3), st.floats(-1.5, 1.5))


def lyapunov(error: tuple[float, float, float]) -> float:
    """(3.11)"""
    x, y, turn = error
    return (x * x + y * y) / 2 + (1 - cos(turn)) / GAINS.k2


@given(errors, st.floats(0, 2), st.floats(-1, 1))
def test_the_lyapunov_function_falls_as_derived(
    error: tuple[float, float, float], v: float, w: float
) -> None:
    """V' = −k₁ x_e² − (k₃/k₂) v_r sin² θ_e (3.14), by differences along robot and reference."""
    robot, h = Pose(1.0, -2.0, 0.7), 1e-6
    c, s = cos(robot.yaw), sin(robot.yaw)
    x, y, turn = error
    reference = Pose(robot.x + c * x - s * y, robot.y + s * x + c * y, robot.yaw + turn)
    twist = tracking_twist(error, (v, w), GAINS)
    after = lyapunov(body_error(exact(reference, (v, w), h), exact(robot, twist, h)))
    before = lyapunov(body_error(exact(reference, (v, w), -h), exact(robot, twist, -h)))
    derived = -GAINS.k1 * x * x - GAINS.k3 / GAINS.k2 * v * sin(turn) ** 2
    assert (after - before) / (2 * h) == pytest.approx(derived, abs=1e-5)


def test_on_the_reference_the_command_is_the_reference() -> None:
    reference = LegsSpec().build()
    law = LyapunovTracking(LyapunovTrackingSpec(), reference)
    for t in (0, 25 * 10**9, 60 * 10**9):
        pose, v, w = reference.at(t)
        assert law.step(t, Estimate(t, np.array(pose), np.eye(3))) == pytest.approx((v, w), abs=1e-12)
    assert law.beyond == 0


def test_an_error_beyond_a_quarter_turn_is_reported() -> None:
    law = LyapunovTracking(LyapunovTrackingSpec(), LegsSpec().build())
    command = law.step(0, Estimate(0, np.array((-20.0, 4.0, 0.9 * pi)), np.eye(3)))
    assert np.isfinite(command).all()
    assert law.beyond == 1
