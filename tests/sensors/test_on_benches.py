"""Sensors on both plants: the ideal robot and the one on wheels, and what becomes of a run when they fail."""

from __future__ import annotations

from math import isfinite

import numpy as np
import pytest

from tests.bench import Ran, ran

PLANTS = ["pliego2023/observer-so2", "pliego2023/observer-so2-bench"]
CAPTURE = "sensors.capture={kind: position, rate: 40, latency: 0.03, noise: 0.002, front: 0.1}"
SPAN = "sensor: capture, start: 0.5, length: 1"
SCANNER = "{kind: range_bearing, rate: 10, range_noise: 0.05, bearing_noise: 0.01, mount: [0.1, 0.0]}"


def moment(run: Ran, name: str, times: np.ndarray) -> np.ndarray:
    rows = np.rint(times / 0.01).astype(int)
    return np.asarray(run.signals[name][rows])


@pytest.mark.parametrize("scenario", PLANTS)
def test_positions_are_recorded_with_the_truth_behind_them(scenario: str) -> None:
    run = ran(scenario, CAPTURE, "duration=2")
    signals = run.signals
    exposed = signals["position/t"]
    np.testing.assert_allclose(exposed, np.arange(79) / 40, atol=1e-12)  # the last two are under way
    np.testing.assert_allclose(signals["position/delivered"] - exposed, 0.03, atol=1e-12)
    on_time = np.abs(exposed / 0.01 - np.rint(exposed / 0.01)) < 1e-6
    truth = moment(run, "truth", exposed[on_time])
    np.testing.assert_allclose(signals["position/true"][on_time], truth[:, :2], atol=1e-12)
    lever = signals["front/true"][on_time] - truth[:, :2]
    np.testing.assert_allclose(np.arctan2(lever[:, 1], lever[:, 0]), truth[:, 2], atol=1e-9)
    np.testing.assert_allclose(np.hypot(*lever.T), 0.1, atol=1e-9)
    noise = signals["position/measured"] - signals["position/true"]
    assert noise.std() == pytest.approx(0.002, rel=0.3)
    assert run.metrics["position_count"] == 79


@pytest.mark.parametrize("scenario", PLANTS)
def test_nan_from_a_sensor_is_counted_and_does_not_end_the_run(scenario: str) -> None:
    run = ran(scenario, "duration=2", f"disturbances=[{{kind: sensor_nan, {SPAN}}}]")
    broken = np.isnan(run.signals["position/measured"]).all(axis=1)
    inside = (run.signals["position/t"] > 0.4999) & (run.signals["position/t"] < 1.4999)
    np.testing.assert_array_equal(broken, inside)
    assert broken.sum() > 80
    assert run.verdict["counts"]["estimator"]["ignored"] == broken.sum()
    assert np.isfinite(run.signals["estimate"]).all()
    assert run.status in (0, 1)
    assert isfinite(run.metrics["position_rms"])


@pytest.mark.parametrize("scenario", PLANTS)
def test_a_sensor_that_is_lost_makes_no_rows(scenario: str) -> None:
    run = ran(scenario, "duration=2", f"disturbances=[{{kind: sensor_loss, {SPAN}}}]")
    exposed = run.signals["position/t"]
    assert not ((exposed > 0.4999) & (exposed < 1.4999)).any()
    assert (exposed > 1.4999).sum() > 40


@pytest.mark.parametrize("scenario", PLANTS)
def test_another_sensor_changes_nobody_elses_noise(scenario: str) -> None:
    alone = ran(scenario, CAPTURE, "duration=1")
    both = ran(scenario, CAPTURE, "duration=1", "sensors.another={kind: bearing, noise: 0.1}")
    for name in ("position/measured", "front/measured", "truth"):
        np.testing.assert_array_equal(alone.signals[name], both.signals[name])


def test_ranges_and_bearings_feed_the_filter_without_a_camera() -> None:
    run = ran("slimane2014/tracking-circle", "duration=4", f"sensors={{scanner: {SCANNER}}}")
    signals = run.signals
    assert len(signals["range/t"]) == len(signals["azimuth/t"]) == 12 * 40
    assert (signals["range/beacon"] == signals["range/claimed"]).all()
    assert run.metrics["range_std"] == pytest.approx(0.05, rel=0.2)
    assert run.metrics["azimuth_std_mdeg"] == pytest.approx(np.degrees(10.0), rel=0.2)
    assert run.metrics["accepted_fraction"] > 0.98
    assert run.metrics["estimate_position_rms"] < 0.03
