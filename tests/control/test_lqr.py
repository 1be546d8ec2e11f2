from __future__ import annotations

from math import cos, inf, sin, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError
from scipy.integrate import solve_ivp
from scipy.linalg import expm, solve_continuous_are

from hilbed.control.lqr import Lqr, body_error, error_model, solve_gain
from hilbed.control.lqr_spec import LqrSpec
from hilbed.control.open_loop import OpenLoop
from hilbed.control.reference import CircleSpec, LineSpec
from hilbed.types import Array, Estimate, Pose

Q, R = 400 * np.eye(3), 400 * np.eye(2)
CIRCLE = CircleSpec(kind="circle", radius=2.0, speed=0.5).build()


def believing(x: float, y: float, yaw: float) -> Estimate:
    return Estimate(0, np.array((x, y, yaw)), np.eye(3))


def test_printed_weights_on_a_line_have_the_closed_form() -> None:
    """The limit of short periods at 0.5 m/s: K = [[1, 0, 0], [0, 1, √2]]."""
    np.testing.assert_allclose(solve_gain(0.5, 0.0, 1e-5, Q, R), [[1, 0, 0], [0, 1, sqrt(2)]], atol=1e-4)


@pytest.mark.parametrize(("v", "w"), [(0.5, 0.0), (0.5, 0.4), (0.3, -0.8), (-0.4, 0.2)])
def test_short_periods_tend_to_the_continuous_regulator(v: float, w: float) -> None:
    A, B = error_model(v, w)
    P = solve_continuous_are(A, B, Q, R)
    np.testing.assert_allclose(solve_gain(v, w, 1e-5, Q, R), np.linalg.solve(R, B.T @ P), atol=1e-3)


@pytest.mark.parametrize(("v", "w"), [(0.5, 0.0), (0.5, 0.4), (-0.4, 0.2)])
def test_gain_is_the_fixed_point_of_dynamic_programming(v: float, w: float) -> None:
    """Beside value iteration with a state held by series, not by the block exponential."""
    A, B = error_model(v, w)
    T = 0.1
    Ad = expm(A * T)
    Bd = (
        sum(
            (np.linalg.matrix_power(A, k) * T ** (k + 1) / _factorial(k + 1) for k in range(12)),
            np.zeros((3, 3)),
        )
        @ B
    )
    P = Q.copy()
    for _ in range(3000):
        K = np.linalg.solve(R + Bd.T @ P @ Bd, Bd.T @ P @ Ad)
        P = Q + Ad.T @ P @ (Ad - Bd @ K)
    np.testing.assert_allclose(solve_gain(v, w, T, Q, R), K, atol=1e-8)


def _factorial(k: int) -> float:
    return float(np.prod(np.arange(1, k + 1)))


def test_error_model_is_the_derivative_of_the_true_error() -> None:
    """ė of the nonlinear robot, by differences, for small errors and small (dv, dw)."""
    v, w = 0.5, 0.3
    A, B = error_model(v, w)
    e, u, h = np.array((0.01, -0.02, 0.015)), np.array((0.01, -0.02)), 1e-5
    robot = Pose(0.0, 0.0, 0.4)
    reference = _placed(robot, e)
    later = _drive(reference, v, w, h), _drive(robot, v * cos(e[2]) + u[0], w + u[1], h)
    rate = (np.array(body_error(*later)) - e) / h
    np.testing.assert_allclose(rate, A @ e - B @ u, atol=2e-3)


def _placed(robot: Pose, e: Array) -> Pose:
    c, s = cos(robot.yaw), sin(robot.yaw)
    return Pose(robot.x + c * e[0] - s * e[1], robot.y + s * e[0] + c * e[1], robot.yaw + e[2])


def _drive(pose: Pose, v: float, w: float, duration: float) -> Pose:
    rates = lambda _, p: (v * cos(p[2]), v * sin(p[2]), w)  # noqa: E731
    x, y, yaw = solve_ivp(rates, (0, duration), pose, rtol=1e-10, atol=1e-12).y[:, -1].tolist()
    return Pose(x, y, yaw)


def test_on_the_reference_the_command_is_the_reference() -> None:
    pose, v, w = CIRCLE.at(3_000_000_000)
    command = Lqr(LqrSpec(), CIRCLE, 10_000_000).step(3_000_000_000, believing(*pose))
    assert command == pytest.approx((v, w))


@settings(max_examples=20, deadline=None)
@given(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), st.floats(-1, 1))
def test_an_ideal_robot_comes_to_the_reference(dx: float, dy: float, dyaw: float) -> None:
    lqr, period = Lqr(LqrSpec(), CIRCLE, 50_000_000), 50_000_000
    start = CIRCLE.at(0).pose
    pose = Pose(start.x + dx, start.y + dy, start.yaw + dyaw)
    for k in range(400):
        v, w = lqr.step(k * period, believing(*pose))
        yaw = pose.yaw + w * 0.025
        pose = Pose(pose.x + v * 0.05 * cos(yaw), pose.y + v * 0.05 * sin(yaw), pose.yaw + w * 0.05)
    assert body_error(CIRCLE.at(400 * period).pose, pose) == pytest.approx((0, 0, 0), abs=2e-3)


def test_commands_are_limited() -> None:
    lqr = Lqr(LqrSpec(max_speed=0.6, max_turn_rate=1.5), CIRCLE, 10_000_000)
    for x in (-100.0, 100.0):
        v, w = lqr.step(0, believing(x, x, 1.0))
        assert abs(v) <= 0.6
        assert abs(w) <= 1.5
    assert lqr.counts()["saturated"] == 2
    lqr.step(0, believing(*CIRCLE.at(0).pose))
    assert lqr.counts()["saturated"] == 2


def test_a_standing_reference_has_gains() -> None:
    line = LineSpec(kind="line", length=1.0, acceleration=0.5).build()
    v, w = Lqr(LqrSpec(), line, 10_000_000).step(10**12, believing(0.9, 0.0, 0.0))
    assert (v, w) == pytest.approx((0.1, 0.0), rel=0.02, abs=1e-6)


def test_open_loop_sends_the_reference_or_stands() -> None:
    _, v, w = CIRCLE.at(0)
    assert OpenLoop(CIRCLE).step(0, believing(5.0, 5.0, 1.0)) == (v, w)
    assert OpenLoop(None).step(0, believing(5.0, 5.0, 1.0)) == (0.0, 0.0)


@pytest.mark.parametrize("bad", [{"error": (0, 1, 1)}, {"effort": (1, inf)}, {"max_speed": -1}, {"gain": 1}])
def test_bad_settings_are_refused(bad: dict[str, object]) -> None:
    with pytest.raises(ValidationError):
        LqrSpec.model_validate(bad)
