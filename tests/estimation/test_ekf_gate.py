from __future__ import annotations

from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed.estimation.association import nearest
from hilbed.estimation.ekf import Ekf
from hilbed.estimation.specs import EkfSpec, InflationSpec
from hilbed.types import Odometry, Pose, Reading
from tests.estimation.experiment import BEACONS, PERIOD, START, experiment, sight

STILL = Odometry(0, 0.0, 0.0, 0.0, 0.0)


def azimuth(beacon: int, error: float = 0.0, named: bool = True, t: int = 0) -> Reading:
    value = sight(START, BEACONS[beacon], (0.0, 0.0))[0] + error
    return Reading("azimuth", t, t, (value,), (0.01,), beacon if named else None)


def test_nis_is_the_squared_innovation_over_its_variance() -> None:
    ekf = Ekf(EkfSpec(gate=3.0), BEACONS, START)
    (innovation,) = ekf.step(0, STILL, [azimuth(0, 0.02)]).innovations
    dx, dy = BEACONS[0][0] - START.x, BEACONS[0][1] - START.y
    r2 = dx * dx + dy * dy
    S = 1e-4 * (dy * dy + dx * dx) / r2**2 + 1e-4 + 1e-4
    assert innovation.nis == pytest.approx(0.02**2 / S)
    assert innovation.accepted
    assert innovation.dof == 1


@pytest.mark.parametrize(("gate", "accepted"), [(3.0, False), (8.0, True), (None, True)])
def test_the_gate_refuses_what_lies_beyond(gate: float | None, accepted: bool) -> None:
    ekf = Ekf(EkfSpec(gate=gate), BEACONS, START)
    estimate = ekf.step(0, STILL, [azimuth(0, 0.1)])  # S is about 2e-4: 7 sigma
    assert estimate.innovations[0].accepted is accepted
    assert (estimate.mean == pytest.approx(START)) is not accepted


def test_refusals_in_a_row_widen_the_belief_until_it_lets_the_truth_in() -> None:
    """A filter that is wrong and too sure: locked out without inflation, back with it."""
    wrong = Pose(START.x, START.y, START.yaw + 0.5)
    errors = {}
    for name, inflation in (("locked", None), ("inflated", InflationSpec(after=5, factor=4.0))):
        ekf = Ekf(EkfSpec(gate=3.0, inflation=inflation), BEACONS, wrong)
        for k in range(60):
            t = k * PERIOD
            last = ekf.step(t, STILL._replace(t=t), [azimuth(b, t=t) for b in range(4)])
        errors[name] = abs(last.mean[2] - START.yaw)
    assert errors["locked"] == pytest.approx(0.5)
    assert errors["inflated"] < 0.02


def test_inflation_stops_when_the_yaw_is_anyones_guess() -> None:
    ekf = Ekf(EkfSpec(gate=0.01), BEACONS, START)
    for k in range(500):
        last = ekf.step(k * PERIOD, STILL._replace(t=k * PERIOD), [azimuth(0, 1.0, t=k * PERIOD)] * 6)
    assert np.all(np.isfinite(last.covariance))
    assert last.covariance[2, 2] < 100 * pi**2


def test_one_acceptance_resets_the_count_of_refusals() -> None:
    ekf = Ekf(EkfSpec(inflation=InflationSpec(after=3, factor=10.0)), BEACONS, START)
    before = ekf.step(0, STILL, []).covariance
    mixed = [azimuth(0, 1.0), azimuth(1, 1.0), azimuth(2), azimuth(3, 1.0)]
    after = ekf.step(PERIOD, STILL._replace(t=PERIOD), [r._replace(t=PERIOD) for r in mixed]).covariance
    assert np.trace(after) < np.trace(before)


def test_anonymous_readings_find_their_beacons() -> None:
    steps = experiment(4, 200)
    named, nameless = Ekf(EkfSpec(), BEACONS, START), Ekf(EkfSpec(), BEACONS, START)
    for step in steps:
        a = named.step(step.t, step.odometry, step.readings)
        hidden = [r._replace(beacon=None) for r in reversed(step.readings)]
        b = nameless.step(step.t, step.odometry, hidden)
    np.testing.assert_allclose(a.mean, b.mean, atol=2e-3)  # another order within a frame, the same beacons
    np.testing.assert_allclose(a.covariance, b.covariance, rtol=0.05, atol=1e-7)


def test_a_spurious_reading_gets_no_beacon_that_another_reading_fits_better() -> None:
    ekf = Ekf(EkfSpec(), BEACONS, START)
    frame = [azimuth(0, 0.025, named=False), *(azimuth(b, named=False) for b in range(4))]
    innovations = ekf.step(0, STILL, frame).innovations
    assert [i.accepted for i in innovations[1:]] == [True] * 4
    assert not innovations[0].accepted
    assert np.isnan(innovations[0].nis), "five readings of four beacons: one is nobody's"


def test_a_named_reading_keeps_its_beacon_from_the_nameless() -> None:
    ekf = Ekf(EkfSpec(), BEACONS, START)
    innovations = ekf.step(0, STILL, [azimuth(0, named=False), azimuth(0)]).innovations
    assert [i.accepted for i in innovations] == [False, True]


@given(st.lists(st.lists(st.floats(0, 100), min_size=3, max_size=3), max_size=5), st.sets(st.integers(0, 2)))
def test_each_beacon_is_given_once_and_the_closest_pair_first(
    rows: list[list[float]], taken: set[int]
) -> None:
    owner = nearest(rows, taken)
    given_away = [beacon for beacon in owner if beacon is not None]
    assert len(given_away) == len(set(given_away)) == min(len(rows), 3 - len(taken))
    assert not taken & set(given_away)
    free = [(d, i, j) for i, row in enumerate(rows) for j, d in enumerate(row) if j not in taken]
    if free:
        _, i, j = min(free)
        assert owner[i] == j
