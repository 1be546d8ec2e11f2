"""A late reading changes nothing but when the filter knows."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hilbed.estimation.ekf import Ekf
from hilbed.estimation.specs import EkfSpec, OdometrySpec
from hilbed.types import Estimate, Odometry, Reading
from tests.estimation.experiment import BEACONS, PERIOD, START, Errors, Step, experiment

STEPS = experiment(2, 80)
SPEC = EkfSpec()


def run(steps: list[Step], readings: list[Reading], spec: EkfSpec = SPEC) -> list[Estimate]:
    """Gives each reading to the first step at or after its delivery."""
    ekf, rest = Ekf(spec, BEACONS, START), sorted(readings, key=lambda r: r.delivered)
    estimates = []
    for step in steps:
        due = [r for r in rest if r.delivered <= step.t]
        rest = rest[len(due) :]
        estimates.append(ekf.step(step.t, step.odometry, due))
    assert ekf.ignored == 0
    return estimates


def same(a: Estimate, b: Estimate, tolerance: float = 1e-12) -> None:
    np.testing.assert_allclose(a.mean, b.mean, atol=tolerance)
    np.testing.assert_allclose(a.covariance, b.covariance, atol=tolerance)


READINGS = [reading for step in STEPS[:-20] for reading in step.readings]


@settings(max_examples=25, deadline=None)
@given(st.lists(st.integers(0, 15), min_size=len(READINGS), max_size=len(READINGS)))
def test_any_lateness_and_order_end_in_the_same_belief(late: list[int]) -> None:
    spec = EkfSpec(gate=None)
    moved = [r._replace(delivered=r.t + k * PERIOD) for r, k in zip(READINGS, late, strict=True)]
    same(run(STEPS, moved, spec)[-1], run(STEPS, READINGS, spec)[-1], 0.0)


def test_lateness_is_exact_with_gate_and_inflation() -> None:
    """Not even rounding differs."""
    spec = EkfSpec(gate=0.7)
    moved = [r._replace(delivered=r.t + (5 * (r.beacon or 0) % 11) * PERIOD) for r in READINGS]
    late, prompt = run(STEPS, moved, spec)[-1], run(STEPS, READINGS, spec)[-1]
    assert np.array_equal(late.mean, prompt.mean)
    assert np.array_equal(late.covariance, prompt.covariance)


def test_exposure_between_two_odometry_stamps_cuts_the_way() -> None:
    """Beside a run whose odometry really has a sample at the exposure."""
    reading = READINGS[0]._replace(t=10 * PERIOD + PERIOD // 4, delivered=13 * PERIOD)
    coarse = run(STEPS[:20], [reading])[-1]
    ekf = Ekf(EkfSpec(), BEACONS, START)
    for step in STEPS[:20]:
        way, turn = step.odometry.distance, step.odometry.turn
        if step.t == 11 * PERIOD:
            quarter = Odometry(reading.t, way / 4, turn / 4, 0.0, 0.0)
            ekf.step(reading.t, quarter, [reading])
            way, turn = 0.75 * way, 0.75 * turn
        fine = ekf.step(step.t, Odometry(step.t, way, turn, 0.0, 0.0), [])
    same(coarse, fine)


def test_delay_moves_the_exposure() -> None:
    stamped_late = [r._replace(t=r.t + 30_000_000, delivered=r.t + 2 * PERIOD) for r in READINGS]
    stamped_right = [r._replace(delivered=r.t + 2 * PERIOD) for r in READINGS]
    late, right = run(STEPS, stamped_late, EkfSpec(delay=0.03)), run(STEPS, stamped_right)
    for a, b in zip(late, right, strict=True):
        same(a, b)


def test_output_is_carried_from_the_odometry_stamp_to_now() -> None:
    ekf = Ekf(EkfSpec(odometry=OdometrySpec(heading_noise=0.2)), BEACONS, START)
    estimate = ekf.step(40_000_000, Odometry(0, 0.0, 0.0, 0.5, 0.2), [])
    assert estimate.t == 40_000_000
    yaw = START.yaw + 0.004
    expected = (START.x + 0.02 * np.cos(yaw), START.y + 0.02 * np.sin(yaw), START.yaw + 0.008)
    assert estimate.mean == pytest.approx(expected, rel=1e-5)  # the chord is that much shorter than the arc
    assert estimate.covariance[2, 2] == pytest.approx(1e-4 + 0.04 * 0.02 + 0.0025 * 0.008)
    again = ekf.step(40_000_000, Odometry(0, 0.0, 0.0, 0.0, 0.0), [])
    assert again.mean == pytest.approx(START), "the extrapolation must not be kept"


def test_an_exposure_after_the_last_odometry_counts_at_once_and_once() -> None:
    reading = READINGS[0]._replace(t=6 * PERIOD, delivered=6 * PERIOD, value=(READINGS[0].value[0] + 0.01,))
    old = [s._replace(odometry=s.odometry._replace(t=s.t - PERIOD)) for s in STEPS[1:12]]
    ekf = Ekf(EkfSpec(), BEACONS, START)
    estimates = [ekf.step(s.t, s.odometry, [reading] if s.t == 6 * PERIOD else []) for s in old]
    assert [len(e.innovations) for e in estimates] == [0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0]
    assert estimates[5].covariance[2, 2] < estimates[4].covariance[2, 2]
    late = Ekf(EkfSpec(), BEACONS, START)
    for s in old:
        last = late.step(s.t, s.odometry, [reading] if s.t == 10 * PERIOD else [])
    same(estimates[-1], last)


def test_a_reading_older_than_the_memory_is_counted_and_ignored() -> None:
    ekf = Ekf(EkfSpec(memory=0.5), BEACONS, START)
    for step in STEPS:
        ekf.step(step.t, step.odometry, [])
    ekf.step(STEPS[-1].t, STEPS[-1].odometry._replace(distance=0.0, turn=0.0), [READINGS[0]])
    assert ekf.ignored == 1


def test_memory_stays_bounded() -> None:
    ekf = Ekf(EkfSpec(memory=0.5), BEACONS, START)
    for step in experiment(1, 300, Errors()):
        ekf.step(step.t, step.odometry, step.readings)
    assert len(ekf._timeline.nodes) <= 0.5e9 / PERIOD + 3
