"""What every Estimator does: whatever arrives, a pose with a covariance, made of nothing but its inputs."""

from __future__ import annotations

from math import inf, nan, pi
from typing import Any, get_args

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.random import default_rng

from hilbed.build.minds import Surroundings, make_estimator
from hilbed.estimation import EstimatorSpec
from hilbed.ports import Estimator
from hilbed.types import Estimate, Odometry, Pose, Reading

PERIOD = 10_000_000
KNOWN = Surroundings([(4.0, 0.0), (0.0, 4.0), (-4.0, -1.0)], Pose(0.5, -0.5, 3.0), (0.1, 0.0), default_rng(0))
SPECS: dict[str, Any] = {spec.model_fields["kind"].default: spec for spec in get_args(EstimatorSpec)}

SMALL: dict[str, dict[str, Any]] = {"particles": {"particles": 25}}
WITH_DOUBT = "ekf", "odometry"  # from the start, and without chance

anything = st.one_of(st.floats(), st.sampled_from([nan, inf, -inf, 1e300, -1e300, 0.0]))
usual = st.floats(-0.02, 0.02)
stamps = st.integers(-(10**12), 10**12)
no_drives = st.just({})
wild = st.builds(Odometry, stamps, anything, anything, anything, anything, no_drives)
tame = st.builds(Odometry, st.just(0), usual, usual, st.floats(-1, 1), st.floats(-1, 1), no_drives)
readings = st.builds(
    Reading,
    st.sampled_from(["azimuth", "range", "position", "pose", "front", "smell"]),
    stamps,
    stamps,
    st.lists(anything, max_size=3).map(tuple),
    st.lists(anything, max_size=3).map(tuple),
    st.one_of(st.none(), st.integers(-3, 9)),
)
steps = st.lists(
    st.tuples(st.one_of(wild, tame), st.lists(readings, max_size=4)), min_size=1, max_size=8
)  # fmt: skip


def made(kind: str) -> Estimator:
    spec = SPECS[kind].model_validate(SMALL.get(kind, {}))
    return make_estimator(spec, KNOWN._replace(rng=default_rng(0)))


def fed(estimator: Estimator, given_: list[tuple[Odometry, list[Reading]]]) -> list[Estimate]:
    return [
        estimator.step(k * PERIOD, odometry._replace(t=odometry.t or k * PERIOD), found)
        for k, (odometry, found) in enumerate(given_)
    ]


@pytest.mark.parametrize("kind", SPECS)
@settings(max_examples=60, deadline=None)
@given(steps)
def test_it_survives_anything(kind: str, given_: list[tuple[Odometry, list[Reading]]]) -> None:
    for k, estimate in enumerate(fed(made(kind), given_)):
        assert estimate.t == k * PERIOD
        assert estimate.mean.shape == (3,)
        assert estimate.covariance.shape == (3, 3)
        assert np.isfinite(estimate.mean).all()
        assert -pi < estimate.mean[2] <= pi
        assert all(i.dof > 0 and i.nis >= 0.0 for i in estimate.innovations)
        if np.isnan(estimate.covariance).all():
            continue  # it states none
        assert np.isfinite(estimate.covariance).all()
        assert np.array_equal(estimate.covariance, estimate.covariance.T)
        assert np.linalg.eigvalsh(estimate.covariance).min() >= -1e-9 * np.trace(estimate.covariance)


@pytest.mark.parametrize("kind", SPECS)
@settings(max_examples=20, deadline=None)
@given(steps)
def test_the_same_twice_is_the_same_and_nothing_handed_over_changes_later(
    kind: str, given_: list[tuple[Odometry, list[Reading]]]
) -> None:
    estimator, copies, kept = made(kind), [], []
    for k, (odometry, found) in enumerate(given_):
        before = list(found)
        kept.append(estimator.step(k * PERIOD, odometry, found))
        copies.append((kept[-1].mean.copy(), kept[-1].covariance.copy()))
        assert len(found) == len(before)
    again = made(kind)
    for k, (odometry, found) in enumerate(given_):
        other = again.step(k * PERIOD, odometry, found)
        for estimate in (kept[k], other):
            assert np.array_equal(estimate.mean, copies[k][0])
            assert np.array_equal(estimate.covariance, copies[k][1], equal_nan=True)


@pytest.mark.parametrize("kind", WITH_DOUBT)
def test_it_starts_where_it_is_told_to_and_doubts_more_on_the_way(kind: str) -> None:
    estimator = made(kind)
    first = estimator.step(0, Odometry(0, 0.0, 0.0, 0.0, 0.0), [])
    assert first.mean == pytest.approx(KNOWN.start)
    doubts = [float(np.trace(first.covariance))]
    for k in range(1, 200):
        last = estimator.step(k * PERIOD, Odometry(k * PERIOD, 0.01, 0.0, 1.0, 0.0), [])
        doubts.append(float(np.trace(last.covariance)))
    assert doubts == sorted(doubts)
    way = 199 * 0.01
    expected = KNOWN.start.x + way * np.cos(3.0), KNOWN.start.y + way * np.sin(3.0), 3.0
    assert last.mean == pytest.approx(expected, abs=1e-6)
