"""Papers on the bench: what their criteria ask for, with another seed than the one they were tuned with."""

from __future__ import annotations

import numpy as np
import pytest

from tests.bench import ran


@pytest.mark.parametrize("seed", [11, 12])
@pytest.mark.parametrize(
    ("scenario", "settings"),
    [
        ("lages2017/start-1-bench", ["duration=50"]),
        ("pliego2023/observer-global-bench", ["duration=22"]),
        ("pliego2023/eight-bench", ["duration=20", "disturbances.2.start=16", "disturbances.3.start=18"]),
    ],
)
def test_a_twin_keeps_its_tolerance(scenario: str, settings: list[str], seed: int) -> None:
    run = ran(scenario, *settings, seed=seed)
    assert run.verdict["reason"] == ""
    assert run.status == 0
    assert np.isfinite(run.signals["estimate"]).all()


def test_a_filter_that_loses_its_sensor_drives_on_by_odometry() -> None:
    """Lost for good after 5 s: what is left is a wheel that is 1 % too large, and nobody who says so."""
    large, lost = (
        "{kind: wheel_radius, drive: left, size: 1.01}",
        "{kind: sensor_loss, sensor: gps, start: 5}",
    )
    run = ran("lages2017/start-1-bench", "duration=50", f"disturbances=[{large}, {lost}]")
    assert run.metrics["position_count"] == 25
    assert 0.005 < run.metrics["reference_distance_final"] < 0.4
    assert run.verdict["counts"]["estimator"]["ignored"] == 0
