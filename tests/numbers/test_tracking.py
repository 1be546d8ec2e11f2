"""Fig. 6 b of Slimane et al.: the stadium with and without pose control, false azimuths.

Forty seeds are `hilbed sweep slimane2014/tracking-stadium --seeds 1..40`; here it is two.
"""

from __future__ import annotations

import numpy as np
import pytest

from tests.bench import Ran, ran

NAME = "slimane2014/tracking-stadium"
SPURIOUS = "sensors.camera.spurious=0.15"  # a frame; with three beacons in view, 5 % of the azimuths
SEEDS = (1, 2)


def nees(run: Ran) -> float:
    """Returns the mean of eᵀ P⁻¹ e over the run, without the metrics' code."""
    error = run.signals["estimate"] - run.signals["truth"]
    error[:, 2] = np.angle(np.exp(1j * error[:, 2]))
    inverse = np.linalg.inv(run.signals["covariance"])
    return float(np.mean(np.einsum("ni,nij,nj->n", error, inverse, error)))


def disturbed(run: Ran) -> bool:
    """Returns whether both wheels were loaded and one slipped."""
    drives = [f"tick/drive/{drive}" for drive in ("left", "right")]
    loaded = all(run.signals[f"{drive}/load_torque"].max() > 1.0 for drive in drives)
    return loaded and max(np.abs(run.signals[f"{drive}/slip"]).max() for drive in drives) > 0.02


@pytest.mark.parametrize("seed", SEEDS)
def test_the_stadium_is_tracked_and_without_pose_control_it_is_not(seed: int) -> None:
    closed, straying = ran(NAME, seed=seed), ran(f"{NAME}-open", seed=seed)
    assert (closed.status, straying.status) == (0, 0)
    estimate = closed.metrics["estimate_position_rms"]
    assert estimate <= 0.05
    assert closed.metrics["odometry_position_rms"] >= 5.0 * estimate
    assert closed.metrics["cross_track_rms"] <= 0.06
    name = "reference_distance_rms"
    assert straying.metrics[name] >= 5.0 * closed.metrics[name]
    assert closed.metrics["nees_mean"] == pytest.approx(nees(closed), rel=1e-6)
    assert 0.5 <= nees(closed) <= 3.66
    assert disturbed(closed)


@pytest.mark.parametrize("seed", SEEDS)
def test_five_percent_of_false_azimuths_do_not_lead_it_astray(seed: int) -> None:
    run = ran(NAME, SPURIOUS, "duration=40", seed=seed)
    false, real = run.metrics["azimuth_spurious"], run.metrics["azimuth_count"]
    assert false / (false + real) == pytest.approx(0.05, abs=0.012)
    assert run.status == 0, "every criterion as without them"
    assert run.metrics["estimate_position_max"] <= 0.05


@pytest.mark.parametrize("seed", SEEDS)
def test_without_the_gate_they_do(seed: int) -> None:
    run = ran(NAME, SPURIOUS, "estimator.gate=null", seed=seed)
    assert run.status != 0
    assert run.metrics["estimate_position_max"] > 1.0
    assert run.metrics["nees_mean"] > 1000.0
