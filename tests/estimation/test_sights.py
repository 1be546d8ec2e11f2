from __future__ import annotations

from math import atan2, hypot, pi, sin

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from hilbed.angles import wrap
from hilbed.estimation.observability import (
    full_determinant,
    full_rows,
    observable,
    reduced_determinant,
    reduced_rows,
)
from hilbed.estimation.sights import (
    Sight,
    Survey,
    angle,
    sight,
    sight_jacobian,
    surveyed,
    surveyed_covariance,
)
from hilbed.types import Array, Pose

places = st.floats(-5, 5)
poses = st.builds(Pose, places, places, st.floats(-3.1, 3.1))
spans = st.floats(0.3, 4.0)


def off_the_line(pose: Pose) -> None:
    assume(abs(pose.x) > 0.2)


@given(poses, spans)
def test_the_survey_undoes_the_sights_wherever_the_robot_is(pose: Pose, l: float) -> None:  # noqa: E741
    """Both sides of the landmarks' line: (8) with r_B squared and atan2."""
    off_the_line(pose)
    found = surveyed(sight(pose, (0.0, 0.0)), sight(pose, (0.0, l)))
    assert found[:2] == pytest.approx(pose[:2], abs=1e-9)
    assert wrap(found.yaw - pose.yaw) == pytest.approx(0.0, abs=1e-9)
    assert found.l == pytest.approx(l, abs=1e-9)


@given(poses)
def test_an_azimuth_is_the_direction_to_the_landmark_in_the_robots_frame(pose: Pose) -> None:
    off_the_line(pose)
    azimuth = wrap(atan2(1.0 - pose.y, 0.0 - pose.x) - pose.yaw)
    assert wrap(angle(azimuth) - sight(pose, (0.0, 1.0)).phi) == pytest.approx(0.0, abs=1e-12)


def sights_of(state: Array) -> Array:
    pose = Pose(*state[:3])
    return np.array((*sight(pose, (0.0, 0.0)), *sight(pose, (0.0, float(state[3])))))


def numeric_jacobian(state: Array) -> Array:
    h = 1e-6
    columns = [(sights_of(state + h * e) - sights_of(state - h * e)) / (2 * h) for e in np.eye(4)]
    return np.array(columns).T


@given(poses, spans)
def test_the_jacobian_is_that_of_the_sights(pose: Pose, l: float) -> None:  # noqa: E741
    off_the_line(pose)
    sights = sights_of(np.array((*pose, l)))
    assume(max(abs(sights[1]), abs(sights[3])) < 3.1)  # the numeric difference must not wrap
    np.testing.assert_allclose(
        sight_jacobian(Survey(*pose, l)), numeric_jacobian(np.array((*pose, l))), atol=1e-5
    )


def test_covariance_of_the_survey_is_that_of_a_sample() -> None:
    rng = np.random.default_rng(3)
    pose, l, P = Pose(1.0, 2.0, -0.5), 1.0, np.diag([1e-3, 1e-4, 1e-3, 1e-4]) ** 2 * 1e2  # noqa: E741
    truth = np.array((*sight(pose, (0.0, 0.0)), *sight(pose, (0.0, l))))
    samples = rng.multivariate_normal(truth, P, 20000)
    found = np.array([surveyed(Sight(a, b), Sight(c, d)) for a, b, c, d in samples])
    covariance = surveyed_covariance(Survey(*pose, l), P)
    scale = np.sqrt(np.outer(np.diag(covariance), np.diag(covariance)))
    np.testing.assert_allclose(np.cov(found.T) / scale, covariance / scale, atol=0.05)


def test_landmarks_in_one_place_give_no_frame_but_finite_numbers() -> None:
    pose = Pose(1.0, 3.0, 0.4)
    found = surveyed(sight(pose, (0.0, 0.0)), sight(pose, (0.0, 0.0)))
    assert np.isfinite(found).all()
    assert surveyed_covariance(found, 1e-6 * np.eye(4))[0, 0] == 1e6


@given(poses, spans)
def test_determinant_of_the_jacobian(pose: Pose, l: float) -> None:  # noqa: E741
    off_the_line(pose)
    a, b = sight(pose, (0.0, 0.0)), sight(pose, (0.0, l))
    det = abs(np.linalg.det(sight_jacobian(Survey(*pose, l))))
    assert det == pytest.approx(l / (a.r * b.r), rel=1e-6)


@pytest.mark.parametrize("pose", [Pose(0.0, 0.0, 0.3), Pose(0.0, 1.0, 0.3)])
def test_a_robot_on_a_landmark_has_a_finite_survey(pose: Pose) -> None:
    found = surveyed(sight(pose, (0.0, 0.0)), sight(pose, (0.0, 1.0)))
    assert np.isfinite(found).all()
    assert np.isfinite(sight_jacobian(Survey(*pose, 1.0))).all()


def lie_rows(state: Array, u: float) -> Array:
    """Gradients of both bearings and of their derivatives along the motion, all by differences."""

    def bearings(s: Array) -> Array:
        return sights_of(s)[1::2]

    def rates(s: Array) -> Array:
        h = 1e-4
        f = np.array((np.cos(s[2]), np.sin(s[2]), u, 0.0))
        return np.asarray((bearings(s + h * f) - bearings(s - h * f)) / (2 * h))

    h = 1e-4
    steps = h * np.eye(4)
    gradient = [
        np.concatenate([(q(state + e) - q(state - e)) / (2 * h) for q in (bearings, rates)]) for e in steps
    ]
    return np.array(gradient).T


@given(poses, spans)
def test_determinants_are_those_of_the_lie_derivatives(pose: Pose, l: float) -> None:  # noqa: E741
    off_the_line(pose)
    state = np.array((*pose, l))
    a, b = sight(pose, (0.0, 0.0)), sight(pose, (0.0, l))
    assume(max(abs(a.phi), abs(b.phi)) < 3.0 and min(a.r, b.r) > 0.5)
    closed = float(full_determinant(state))
    assert closed == pytest.approx(l * sin(a.phi) * sin(b.phi) / (a.r * b.r) ** 3, rel=1e-9, abs=1e-12)
    assert abs(np.linalg.det(lie_rows(state, 0.0))) == pytest.approx(abs(closed), rel=1e-3, abs=1e-4)
    rows = full_rows(Survey(*pose, l), steering=False)
    assert abs(np.linalg.det(rows)) == pytest.approx(abs(closed), rel=1e-9, abs=1e-12)


@given(st.floats(0.3, 9.0), st.floats(-pi, pi).filter(lambda phi: abs(phi) > 1e-9))
def test_the_reduced_determinant_is_that_of_its_rows(r: float, phi: float) -> None:
    rows = reduced_rows(r, phi, steering=False)
    assert np.linalg.det(rows) == pytest.approx(float(reduced_determinant(np.array(r), np.array(phi))))
    assert observable(reduced_rows(r, phi, steering=True))  # (12) holds for u = 0 only


def test_straight_at_a_landmark_only_steering_shows_its_distance() -> None:
    ahead = Pose(3.0, 0.0, pi)
    a = sight(ahead, (0.0, 0.0))
    assert not observable(reduced_rows(*a, steering=False))
    state = Survey(*ahead, 1.0)
    assert not observable(full_rows(state, steering=False))
    assert observable(full_rows(state, steering=True))
    assert observable(full_rows(Survey(1.0, 2.0, -0.5, 1.0), steering=False))


def test_determinants_follow_a_path_and_a_landmark_is_not_observable() -> None:
    path = np.array([(1 + s * np.cos(-0.5), 2 + s * np.sin(-0.5), -0.5, 1.0) for s in np.linspace(0, 5, 6)])
    values = full_determinant(path)
    assert values.shape == (6,)
    assert np.all(np.diff(values) < 0)  # ever less, the further away
    with np.errstate(all="ignore"):
        assert not observable(reduced_rows(0.0, 1.0, steering=True))


def test_distance_of_a_sight() -> None:
    assert sight(Pose(1.0, 2.0, 0.0), (0.0, 0.0)).r == pytest.approx(hypot(1, 2))
