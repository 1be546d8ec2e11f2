from __future__ import annotations

from math import inf, nan

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hilbed.estimation.dead_reckoning import DeadReckoning
from hilbed.estimation.ekf import Ekf
from hilbed.estimation.specs import DeadReckoningSpec, EkfSpec
from hilbed.types import Odometry, Reading
from tests.estimation.experiment import BEACONS, PERIOD, START, experiment

anything = st.one_of(st.floats(), st.sampled_from([nan, inf, -inf, 0.0, 1e300, -1e300]))
kinds = st.sampled_from(["azimuth", "range", "position", "rubbish"])
stamps = st.integers(-(10**12), 10**12)
readings = st.builds(
    Reading,
    kinds,
    stamps,
    stamps,
    st.tuples(anything),
    st.tuples(anything),
    st.one_of(st.none(), st.integers(-3, 9)),
)


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.tuples(stamps, anything, anything, anything, anything), min_size=1, max_size=6),
    st.lists(readings, max_size=6),
    st.sampled_from([3.0, None]),
)
def test_nothing_that_arrives_raises_or_spoils_the_belief(
    ways: list[tuple[int, float, float, float, float]], wild: list[Reading], gate: float | None
) -> None:
    ekf = Ekf(EkfSpec(gate=gate), BEACONS, START)
    for k, way in enumerate(ways):
        estimate = ekf.step(k * PERIOD, Odometry(*way), wild)
        assert np.isfinite(estimate.mean).all()
        assert np.array_equal(estimate.covariance, estimate.covariance.T)
        assert np.linalg.eigvalsh(estimate.covariance).min() > -1e-6 * np.trace(estimate.covariance)


@pytest.mark.parametrize(
    "reading",
    [
        Reading("azimuth", 0, 0, (nan,), (0.01,), 0),
        Reading("azimuth", 0, 0, (inf,), (0.01,), None),
        Reading("azimuth", 0, 0, (0.1,), (nan,), 0),
        Reading("azimuth", 0, 0, (0.1,), (0.0,), 0),
        Reading("azimuth", 0, 0, (0.1,), (-0.01,), 0),
        Reading("azimuth", 0, 0, (0.1,), (0.01,), 4),
        Reading("azimuth", 0, 0, (), (), 0),
        Reading("position", 0, 0, (0.1, 0.2), (0.01, 0.01), None),
        Reading("azimuth", 2**60, 2**60, (0.1,), (0.01,), 0),
    ],
)
def test_unusable_readings_are_counted_and_change_nothing(reading: Reading) -> None:
    ekf = Ekf(EkfSpec(), BEACONS, START)
    estimate = ekf.step(0, Odometry(0, 0.0, 0.0, 0.0, 0.0), [reading])
    assert ekf.ignored == 1
    assert estimate.innovations == ()
    assert estimate.mean == pytest.approx(START)
    np.testing.assert_allclose(estimate.covariance, np.eye(3) * 1e-4)


@pytest.mark.parametrize("way", [(nan, 0.0), (0.0, nan), (inf, 0.0), (1e9, 0.0)])
def test_unusable_odometry_is_counted_and_its_speeds_bridge_the_gap(way: tuple[float, float]) -> None:
    ekf = Ekf(EkfSpec(), BEACONS, START)
    estimate = ekf.step(PERIOD, Odometry(PERIOD, *way, 0.5, 0.0), [])
    assert ekf.ignored == 1
    assert np.hypot(*(estimate.mean[:2] - START[:2])) == pytest.approx(0.025)


def test_dead_reckoning_holds_still_on_what_it_cannot_use() -> None:
    reckoning = DeadReckoning(DeadReckoningSpec(), START)
    estimate = reckoning.step(0, Odometry(0, nan, 0.1, nan, nan), [])
    assert reckoning.ignored == 1
    assert estimate.mean == pytest.approx(START)


@pytest.mark.parametrize("kind", ["azimuth", "range"])
def test_a_beacon_under_the_sensor_is_counted_and_leaves_finite_numbers(kind: str) -> None:
    ekf = Ekf(EkfSpec(gate=None), [START[:2], *BEACONS], START)
    reading = Reading(kind, 0, 0, (0.3,), (0.01,), 0)
    estimate = ekf.step(0, Odometry(0, 0.0, 0.0, 0.0, 0.0), [reading])
    assert ekf.counts() == {"ignored": 0, "touching": 1, "restarted": 0}
    assert np.isfinite(estimate.mean).all()
    assert np.linalg.eigvalsh(estimate.covariance).min() > 0


def test_a_covariance_that_round_off_spoils_starts_afresh_and_is_counted() -> None:
    """Thirty decimal digits between doubt and noise; without the check NIS and variances turn negative."""
    spec = EkfSpec.model_validate(
        {"initial_std": (1e6, 1e6, 1e6), "range": {"std": 1e-9}, "azimuth": {"std": 1e-9}, "gate": None}
    )
    ekf, innovations, least = Ekf(spec, BEACONS, START), [], inf
    for step in experiment(1, 40, kinds=("azimuth", "range")):
        estimate = ekf.step(step.t, step.odometry, step.readings)
        innovations += [innovation.nis for innovation in estimate.innovations]
        least = min(least, float(estimate.covariance.diagonal().min()))
    assert ekf.restarted > 0
    assert min(innovations) >= 0
    assert least > 0
