from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import chi2, multivariate_normal

from hilbed.estimation.consistency import mean_bounds, nees, pose_error
from hilbed.estimation.dead_reckoning import DeadReckoning
from hilbed.estimation.ekf import Ekf
from hilbed.estimation.specs import DeadReckoningSpec, EkfSpec, OdometrySpec
from hilbed.types import Pose
from tests.estimation.experiment import BEACONS, START, Errors, experiment

ODOMETRY = OdometrySpec(distance_noise=0.02, heading_noise=0.05, turn_noise=0.02)


def test_nees_is_what_the_density_says() -> None:
    rng = np.random.default_rng(0)
    A = rng.normal(size=(5, 3, 3))
    P, e = A @ A.transpose(0, 2, 1) + np.eye(3), rng.normal(size=(5, 3))
    expected = [
        2 * (multivariate_normal(cov=p).logpdf(np.zeros(3)) - multivariate_normal(cov=p).logpdf(v))
        for p, v in zip(P, e, strict=True)
    ]
    np.testing.assert_allclose(nees(e, P), expected)


def test_nees_of_the_unknown_and_of_no_covariance_is_nan() -> None:
    e = np.array([[np.nan, 0, 0], [1, 1, 1], [1, 1, 1], [1, 1, 1]])
    P = np.array([np.eye(3), np.zeros((3, 3)), np.diag([1.0, 1, -1]), np.eye(3)])
    np.testing.assert_array_equal(nees(e, P), [np.nan, np.nan, np.nan, 3.0])


def test_bounds_hold_the_told_share_of_means() -> None:
    low, high = mean_bounds(3, 10, 0.9)
    means = np.random.default_rng(1).chisquare(3, (20000, 10)).mean(axis=1)
    assert np.mean((means > low) & (means < high)) == pytest.approx(0.9, abs=0.01)
    assert mean_bounds(1, 1)[1] == pytest.approx(chi2.ppf(0.975, 1))


def test_yaw_errors_are_wrapped() -> None:
    error = pose_error(np.array([[0, 0, 3.1]]), np.array([[0, 0, -3.1]]))
    assert error[0, 2] == pytest.approx(6.2 - 2 * np.pi)


@pytest.mark.parametrize("kinds", [("azimuth",), ("azimuth", "range")])
def test_the_filter_is_as_good_as_it_says(kinds: tuple[str, ...]) -> None:
    """Four seeds of 60 s with the noise that it is told of.

    Errors last about a second, so a run is worth some 60 independent NEES; NIS are independent.
    """
    values, innovations = [], []
    for seed in range(4):
        rng = np.random.default_rng(100 + seed)
        offset = rng.normal(0, 0.01, 3)
        ekf = Ekf(EkfSpec(odometry=ODOMETRY, gate=None), BEACONS, Pose(*(np.array(START) + offset).tolist()))
        for step in experiment(seed, 1200, Errors(), kinds):
            estimate = ekf.step(step.t, step.odometry, step.readings)
            innovations += [i.nis for i in estimate.innovations]
            error = pose_error(estimate.mean[None], np.array([step.truth]))
            values.append(nees(error, estimate.covariance[None])[0])
    low, high = mean_bounds(3, 4 * 60, 0.999)
    assert low < np.mean(values) < high
    low, high = mean_bounds(1, len(innovations), 0.999)
    assert low < np.mean(innovations) < high


def test_dead_reckoning_is_as_bad_as_it_says() -> None:
    """Ends of 200 short runs: independent, so the bound is sharp."""
    values = []
    for seed in range(200):
        reckoning = DeadReckoning(DeadReckoningSpec(odometry=ODOMETRY, initial_std=(1e-3,) * 3), START)
        for step in experiment(seed, 60):
            estimate = reckoning.step(step.t, step.odometry, step.readings)
        error = pose_error(estimate.mean[None], np.array([step.truth]))
        values.append(nees(error, estimate.covariance[None])[0])
    low, high = mean_bounds(3, len(values), 0.999)
    assert low < np.mean(values) < high
