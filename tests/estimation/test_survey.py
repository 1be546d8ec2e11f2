"""The full-state filter: beside the reduced form, a textbook filter with numeric Jacobians, chi-square."""

from __future__ import annotations

from math import atan2, cos, inf, nan, sin

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from pydantic import ValidationError

from hilbed.angles import wrap
from hilbed.estimation.bearing_observers import NEAREST, reduced_rates
from hilbed.estimation.bearing_specs import SurveySpec
from hilbed.estimation.odometry_model import OdometryModel
from hilbed.estimation.sights import Sight, sight
from hilbed.estimation.survey_estimator import SurveyEstimator
from hilbed.estimation.survey_filter import Belief, corrected, moved_on, surprise
from hilbed.plant.kinematics import exact
from hilbed.types import Array, Odometry, Pose, Reading

T = 20_000_000
START = Pose(1.0, 2.0, -0.5)
PLACES = ((0.0, 0.0), (0.0, 1.0))
MODEL = OdometryModel(distance_noise=0.02, heading_noise=0.05, turn_noise=0.03)
P0 = np.array([[4, 1, 0, 1], [1, 5, 1, 0], [0, 1, 1, 0.5], [1, 0, 0.5, 3]]) * 1e-3


@given(st.floats(0.3, 4), st.floats(-3, 3), st.floats(-2.9, 2.9), st.floats(-1, 1))
def test_the_reduced_form_is_the_full_one_in_other_coordinates(
    x: float, y: float, yaw: float, u: float
) -> None:
    """(7) and (3): r and φ of both landmarks along the motion, by differences."""
    h = 1e-6
    pose, after = Pose(x, y, yaw), Pose(x + h * cos(yaw), y + h * sin(yaw), yaw + h * u)
    for place in PLACES:
        a, b = sight(pose, place), sight(after, place)
        assume(a.r > 0.2)
        dr, dphi = reduced_rates(*a)
        assert (b.r - a.r) / h == pytest.approx(dr, abs=1e-4)
        assert wrap(b.phi - a.phi) / h == pytest.approx(dphi + u, abs=1e-4)


def pair(step: tuple[float, float], x: Array) -> Array:
    """Both sights after an arc, by way of a pose: exact, and independent of the filter's complex numbers."""
    after = []
    for inverse, phi in (x[:2], x[2:]):
        pose = exact(Pose(1 / float(inverse), 0.0, float(phi)), step, 1.0)  # the robot at (r, 0), so θ = φ
        seen = sight(pose, (0.0, 0.0))
        after += [1 / seen.r, seen.phi]
    return np.array(after)


def test_it_equals_a_textbook_filter_with_numeric_jacobians() -> None:
    x, P = np.array((1 / 2.2, -1.6, 1 / 1.4, -1.3)), P0.copy()
    belief, h = Belief(Sight(2.2, -1.6), Sight(1.4, -1.3), P0), 1e-6
    rng = np.random.default_rng(0)
    for k in range(60):
        step = (0.03, 0.01 * sin(k / 9))
        F = np.array([(pair(step, x + h * e) - pair(step, x - h * e)) / (2 * h) for e in np.eye(4)]).T
        shifts = ((step[0] + h, step[1]), (step[0], step[1] + h))
        G = np.array([(pair(s, x) - pair(step, x)) / h for s in shifts]).T
        Q = np.diag((0.02**2 * 0.03, 0.05**2 * 0.03 + 0.03**2 * abs(step[1])))
        x, P = pair(step, x), F @ P @ F.T + G @ Q @ G.T
        belief = moved_on(belief, step, MODEL)
        for landmark in (0, 1):
            index, R = 2 * landmark + 1, 1e-4
            phi = wrap(x[index] + rng.normal(0, 0.01))
            S = P[index, index] + R
            assert surprise(belief, landmark, phi, R) == pytest.approx((phi - x[index], S), abs=1e-6)
            K = P[:, index] / S
            x, P = x + K * (phi - x[index]), P - np.outer(K, P[index])
            belief = corrected(belief, landmark, phi, R)
        (a, phi_a), (b, phi_b) = belief.a, belief.b
        np.testing.assert_allclose((1 / a, phi_a, 1 / b, phi_b), x, atol=1e-6)
        np.testing.assert_allclose(belief.P, P, atol=1e-7)


@given(st.floats(0.05, 9), st.floats(-3, 3), st.floats(-0.5, 0.5), st.floats(-1, 1), st.floats(-9, 9))
def test_whatever_is_measured_the_belief_stays_sound(
    r: float, phi: float, ds: float, turn: float, measured: float
) -> None:
    """Over a landmark, backwards, on the spot."""
    belief = moved_on(Belief(Sight(r, phi), Sight(r, 0.0), P0), (ds, turn), MODEL)
    belief = corrected(belief, 1, measured, 1e-6)
    assert np.isfinite((*belief.a, *belief.b)).all()
    assert min(belief.a.r, belief.b.r) >= NEAREST
    assert np.linalg.eigvalsh(belief.P).min() > -1e-7 * np.linalg.eigvalsh(belief.P).max()


class Drive:
    def __init__(self) -> None:
        self.pose, self.t = START, 0

    def odometry(self) -> Odometry:
        return Odometry(self.t, 0.02 if self.t else 0.0, 0.004 if self.t else 0.0, 1.0, 0.2)

    def move(self) -> None:
        self.pose, self.t = exact(self.pose, (1.0, 0.2), 0.02), self.t + T

    def seen(self, rng: np.random.Generator, std: float) -> list[Reading]:
        made = []
        for k, (x, y) in enumerate(PLACES):
            value = wrap(atan2(y - self.pose.y, x - self.pose.x) - self.pose.yaw + rng.normal(0, std))
            made.append(Reading("azimuth", self.t, self.t, (value,), (std,), k))
        return made


def test_late_and_rare_bearings_and_a_gap() -> None:
    """Every fifth cycle, two cycles late, with a second of nothing: in step again."""
    rng, drive = np.random.default_rng(3), Drive()
    estimator, coming = SurveyEstimator(SurveySpec(std=2e-3), START), list[tuple[int, list[Reading]]]()
    for k in range(250):
        if k % 5 == 0 and not 100 <= k < 150:
            coming.append((drive.t + 2 * T, drive.seen(rng, 2e-3)))
        due = [r for at, readings in coming if at <= drive.t for r in readings]
        coming = [(at, readings) for at, readings in coming if at > drive.t]
        estimate = estimator.step(drive.t, drive.odometry(), due)
        left = estimate.mean - drive.pose
        drive.move()
    assert np.abs(left).max() < 0.1
    assert estimator.ignored == 0


def test_what_cannot_be_used_is_counted_and_changes_nothing() -> None:
    clean, dirty, drive = SurveyEstimator(SurveySpec(), START), SurveyEstimator(SurveySpec(), START), Drive()
    bad = [
        Reading("azimuth", 10 * T, 10 * T, (nan,), (1e-3,), 0),
        Reading("azimuth", 10 * T, 10 * T, (0.1,), (1e-3,), 2),
        Reading("azimuth", 10 * T, 10 * T, (0.1,), (1e-3,), None),
        Reading("range", 10 * T, 10 * T, (1.0,), (1e-3,), 0),
        Reading("azimuth", 3 * T, 10 * T, (0.1,), (1e-3,), 0),
        Reading("azimuth", 10**15, 10 * T, (0.1,), (1e-3,), 0),
    ]
    for k in range(20):
        readings = drive.seen(np.random.default_rng(k), 1e-3)
        a = clean.step(drive.t, drive.odometry(), readings)
        b = dirty.step(drive.t, drive.odometry(), readings + (bad if k == 10 else []))
        np.testing.assert_array_equal(a.mean, b.mean)
        drive.move()
    assert dirty.ignored == len(bad)
    broken = dirty.step(drive.t, Odometry(drive.t, nan, inf, nan, nan), [])
    assert np.isfinite(broken.mean).all()


def test_it_starts_from_one_exposure_with_both() -> None:
    estimator, drive, rng = SurveyEstimator(SurveySpec(), START), Drive(), np.random.default_rng(0)
    for k in range(10):
        readings = drive.seen(rng, 1e-3)[k % 2 : k % 2 + 1]
        estimate = estimator.step(drive.t, drive.odometry(), readings)
        assert np.isnan(estimate.covariance).all()
        drive.move()
    estimate = estimator.step(drive.t, drive.odometry(), drive.seen(rng, 1e-3))
    assert np.isfinite(estimate.covariance).all()
    assert estimate.landmark_distance > 0


@pytest.mark.parametrize("bad", [{"distance_std": 0.0}, {"std": 0.0}, {"distances": (1.0,)}, {"Q": 1.0}])
def test_bad_settings_are_refused(bad: dict[str, object]) -> None:
    with pytest.raises(ValidationError):
        SurveySpec.model_validate(bad)
