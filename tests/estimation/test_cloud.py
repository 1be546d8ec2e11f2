from __future__ import annotations

from math import hypot, pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from hilbed.estimation.cloud import WayNoise, advanced, cloud_of, lattice, predicted, summary
from hilbed.types import Array, Pose

start = st.tuples(st.floats(-5, 5), st.floats(-5, 5), st.floats(-3.1, 3.1))


def driven(pose: tuple[float, float, float], distance: float, turn: float) -> Array:
    """The unicycle's equation over unit time, integrated."""
    rates = lambda _, p: (distance * np.cos(p[2]), distance * np.sin(p[2]), turn)  # noqa: E731
    return np.asarray(solve_ivp(rates, (0, 1), pose, rtol=1e-11, atol=1e-12).y[:, -1])


@given(start, st.floats(-2, 2), st.one_of(st.just(0.0), st.floats(-3, 3), st.floats(-1e-7, 1e-7)))
def test_arcs_are_those_of_the_integrated_equation(
    pose: tuple[float, float, float], distance: float, turn: float
) -> None:
    moved = advanced(np.array([pose]), np.array(distance), np.array(turn))[0]
    expected = driven(pose, distance, turn)
    np.testing.assert_allclose(moved[:2], expected[:2], atol=1e-9)
    assert np.cos(moved[2] - expected[2]) == pytest.approx(1)
    assert -pi < moved[2] <= pi


def test_noise_has_the_moments_of_the_model() -> None:
    """Straight on: x ± d σ_t, yaw ± d σ_D, half of its variance along the arc, which moves y by d/2 of it."""
    d, noise, count = 0.3, WayNoise(0.05, 0.2), 200_000
    cloud = predicted(np.zeros((count, 3)), d, 0.0, noise, np.random.default_rng(1))
    mean, covariance = summary(cloud)
    s2 = (d * noise.turn) ** 2
    expected = np.diag([(d * noise.along) ** 2, d**2 / 4 * s2 / 2, s2])
    expected[1, 2] = expected[2, 1] = d / 2 * s2 / 2
    scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    np.testing.assert_allclose(covariance / scale, expected / scale, atol=0.01)  # 4 standard errors
    np.testing.assert_allclose(mean, (d, 0, 0), atol=3e-4)


def test_a_robot_that_stands_or_turns_on_the_spot_is_not_disturbed() -> None:
    cloud = lattice(Pose(1, 2, 3.0), 25, 1.0)
    moved = predicted(cloud, 0.0, 0.5, WayNoise(), np.random.default_rng(1))
    np.testing.assert_allclose(moved, np.add(cloud, (0, 0, 0.5 - 2 * pi)))


def test_the_papers_first_cloud() -> None:
    cloud = lattice(Pose(4, 0, pi), 900, 1.0)
    assert cloud.shape == (900, 3)
    assert len(np.unique(cloud, axis=0)) == 900
    np.testing.assert_allclose(cloud.min(axis=0), (3.5, -0.5, pi))
    np.testing.assert_allclose(cloud.max(axis=0), (4.5, 0.5, pi))
    np.testing.assert_allclose(np.diff(np.unique(cloud[:, 0])), 1 / 29)


@given(st.integers(1, 500), st.floats(0, 3))
def test_any_count_fills_the_square(count: int, side: float) -> None:
    cloud = lattice(Pose(1, 2, 0.5), count, side)
    assert cloud.shape == (count, 3)
    assert np.abs(cloud[:, :2] - (1, 2)).max() <= side / 2 + 1e-12


def test_a_cloud_of_none_is_refused() -> None:
    with pytest.raises(ValueError, match="at least one"):
        lattice(Pose(0, 0, 0), 0, 1.0)


def test_mean_and_covariance_at_the_seam_of_the_angle() -> None:
    rng = np.random.default_rng(2)
    x, y, turn = rng.normal(size=(3, 5000)) * [[0.2], [0.1], [0.1]]
    mean, covariance = summary(cloud_of(x, y, np.where(turn > 0, turn - pi, turn + pi)))
    assert hypot(*mean[:2]) < 0.02
    assert abs(mean[2]) == pytest.approx(pi, abs=0.01)
    np.testing.assert_allclose(covariance, np.cov((x, y, turn), bias=True), atol=1e-5)
