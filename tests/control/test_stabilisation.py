from __future__ import annotations

from math import atan2, cos, hypot, pi, sin

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from hilbed.angles import wrap
from hilbed.control.stabilisation import Gains, stabilising, within_wheel_limit
from hilbed.types import Array, Command, Pose

PRINTED = Gains(0.5, 0.7, 1.3, guard=0.0)
ORIGIN = Pose(0.0, 0.0, 0.0)
coordinate, angle = st.floats(-5, 5), st.floats(-3.1, 3.1)
poses = st.builds(Pose, coordinate, coordinate, angle)


def law(pose: Pose, goal: Pose, gains: Gains) -> tuple[float, float]:
    (u1,), (u2,) = stabilising(np.array([pose]), goal, gains)
    return float(u1), float(u2)


def lyapunov(pose: Array, h: float) -> float:
    """V = e²/2 + (α² + h ψ²)/2."""
    x, y, yaw = pose
    psi = atan2(y, x)
    return float(0.5 * (x * x + y * y + wrap(yaw - psi) ** 2 + h * psi**2))


@given(poses, poses)
def test_the_printed_law_in_polar_coordinates(pose: Pose, goal: Pose) -> None:
    dx, dy = pose.x - goal.x, pose.y - goal.y
    x1 = cos(goal.yaw) * dx + sin(goal.yaw) * dy
    x2 = -sin(goal.yaw) * dx + cos(goal.yaw) * dy
    e, psi = hypot(x1, x2), atan2(x2, x1)
    alpha = wrap(pose.yaw - goal.yaw - psi)
    assume(e > 1e-3 and 1e-3 < abs(alpha) < pi - 1e-6 and abs(psi) < pi - 1e-6)
    u1 = -0.5 * e * cos(alpha)
    u2 = -0.7 * alpha - 0.5 * cos(alpha) * sin(alpha) / alpha * (alpha - 1.3 * psi)
    assert law(pose, goal, PRINTED) == pytest.approx((u1, u2), abs=1e-9)


def test_at_the_goal_the_robot_stands_or_turns_to_its_yaw() -> None:
    goal = Pose(1.0, 3.0, -pi / 2)
    assert law(goal, goal, PRINTED) == pytest.approx((0, 0))
    assert law(goal._replace(yaw=0.0), goal, PRINTED)[1] < 0


def test_where_alpha_is_zero_its_quotient_is_one() -> None:
    """Looking along the line to the goal: u₂ = γ₁ h ψ."""
    psi = 0.4
    assert law(Pose(2 * cos(psi), 2 * sin(psi), psi), ORIGIN, PRINTED) == pytest.approx(
        (-1.0, 0.5 * 1.3 * psi)
    )


def test_at_the_seam_of_alpha_only_the_turn_is_left() -> None:
    """Facing the goal from straight behind α = −π, which counts as π."""
    assert law(Pose(-2.0, 0.0, 0.0), ORIGIN, PRINTED) == pytest.approx((1.0, -0.7 * pi))


@given(angle, angle, st.floats(0, 0.049))
def test_near_the_goal_the_guarded_law_turns_to_the_goals_yaw_whatever_the_direction(
    psi: float, yaw: float, e: float
) -> None:
    guarded = PRINTED._replace(guard=0.05)
    u1, u2 = law(Pose(e * cos(psi), e * sin(psi), yaw), ORIGIN, guarded)
    assert u1 == pytest.approx(-0.5 * e * cos(yaw - psi), abs=1e-12)
    assert u2 == pytest.approx(-0.7 * yaw - 0.5 * cos(yaw) * sin(yaw), abs=1e-9)


@given(poses.filter(lambda pose: hypot(pose.x, pose.y) > 0.06))
def test_beyond_the_guard_both_laws_are_one(pose: Pose) -> None:
    assert law(pose, ORIGIN, PRINTED) == law(pose, ORIGIN, PRINTED._replace(guard=0.05))


@pytest.mark.parametrize("start", [(3, 3, 1.0), (-2, 1, 0.3), (1, -3, -2.5), (0.5, 2, 3.0)])
def test_without_noise_the_lyapunov_function_falls_to_zero(start: tuple[float, float, float]) -> None:
    def rates(_: float, p: Array) -> tuple[float, float, float]:
        u1, u2 = law(Pose(*p.tolist()), ORIGIN, PRINTED)
        return u1 * cos(p[2]), u1 * sin(p[2]), u2

    path = solve_ivp(rates, (0, 60), start, rtol=1e-8, atol=1e-10, max_step=0.1).y.T
    V = np.array([lyapunov(pose, PRINTED.h) for pose in path])
    assert np.diff(V).max() < 1e-8
    assert V[-1] < 1e-4 * V[0]


@given(st.floats(-3, 3), st.floats(-10, 10))
def test_the_wheel_limit_keeps_the_curvature(v: float, w: float) -> None:
    u = within_wheel_limit(Command(v, w), 0.25, 0.471)
    wheels = v - 0.25 * w, v + 0.25 * w
    limited = u.v - 0.25 * u.w, u.v + 0.25 * u.w
    assert max(map(abs, limited)) <= 0.471 * (1 + 1e-12)
    assert u.v * w == pytest.approx(v * u.w, abs=1e-12)
    if max(map(abs, wheels)) <= 0.471 * (1 - 1e-12):
        assert u == Command(v, w)
    else:
        assert max(map(abs, limited)) == pytest.approx(0.471)
