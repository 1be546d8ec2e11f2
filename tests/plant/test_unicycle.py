from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from hilbed.plant.unicycle import InputNoise, arc, disturbed, rk4
from hilbed.types import Command, Pose

poses = st.builds(Pose, st.floats(-5, 5), st.floats(-5, 5), st.floats(-3.1, 3.1))
commands = st.builds(
    Command, st.floats(-2, 2), st.one_of(st.just(0.0), st.floats(-2, 2), st.floats(-1e-9, 1e-9))
)


@given(poses, commands)
def test_arc_and_runge_kutta_agree_with_an_independent_integration(pose: Pose, u: Command) -> None:
    rates = lambda _, p: (u.v * np.cos(p[2]), u.v * np.sin(p[2]), u.w)  # noqa: E731
    x, y, yaw = solve_ivp(rates, (0, 0.2), pose, rtol=1e-11, atol=1e-12).y[:, -1]
    for moved in (arc(pose, u, 0.2), rk4(pose, u, 0.2)):
        assert moved[:2] == pytest.approx((x, y), abs=1e-6)
        assert np.cos(moved.yaw - yaw) == pytest.approx(1)


def test_runge_kutta_is_of_fourth_order() -> None:
    pose, u, T = Pose(1, 2, 0.3), Command(1.0, 2.0), 1.0
    exact = np.array(arc(pose, u, T))
    errors = [np.abs(np.array(rk4(pose, u, T, steps)) - exact)[:2].max() for steps in (4, 8, 16)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(4, abs=0.2)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(4, abs=0.2)


def test_noise_grows_with_the_speed_and_a_robot_that_stands_has_none() -> None:
    rng, noise = np.random.default_rng(1), InputNoise(0.1, 0.3)
    drawn = np.array([disturbed(Command(-2.0, 0.5), noise, rng) for _ in range(20_000)])
    np.testing.assert_allclose(drawn.mean(0), (-2.0, 0.5), atol=0.02)
    np.testing.assert_allclose(np.cov(drawn.T), np.diag((0.04, 0.36)), rtol=0.05, atol=0.003)
    assert disturbed(Command(0.0, 0.5), noise, rng) == Command(0.0, 0.5)
