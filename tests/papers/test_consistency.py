"""NEES and NIS of every Kalman filter over 50 seeds of an ideal scenario whose noise it is told.

Bar-Shalom, Li, Kirubarajan (2001), section 5.4: in at least 90 % of the steps the mean over the runs is
inside its 95 % bounds.
"""

from __future__ import annotations

from collections.abc import Callable
from math import hypot
from typing import NamedTuple

import numpy as np
import pytest

from hilbed.estimation.consistency import mean_bounds, nees, pose_error
from hilbed.types import Array
from tests.bench import Ran, ran

RUNS = 50
STD, DOUBT = 2e-3, 0.02  # rad of a bearing, m of a first guess of a distance
STEP = 0.02  # m a cycle of the experiments with two landmarks
EYE = f"sensors.landmarks={{kind: bearing, rate: 50, noise: {STD}, latency: 0}}"


class Case(NamedTuple):
    """A scenario, what is changed in it for a seed, and how many scalar readings one exposure has."""

    scenario: str
    settings: Callable[[int], list[str]]
    readings: int


def guesses(seed: int) -> list[float]:
    """r̂_A, r̂_B about the truth of Fig. 3's start, (1, 2)."""
    rng = np.random.default_rng(1000 + seed)
    return [hypot(1, 2) + rng.normal(0, DOUBT), hypot(1, 1) + rng.normal(0, DOUBT)]


def sights(form: str) -> Case:
    """Both filters of Ishikawa & Sampei: bearings each 20 mm, a motion without noise."""
    R = STD**2 * (STEP if form == "bucy" else 1.0)  # rad² m, or rad² a bearing

    def settings(seed: int) -> list[str]:
        told = f"Q: [1.0e-12, 1.0e-12], R: {R:.12f}, P0: [{DOUBT**2:.12f}, {STD**2:.12f}], step: {STEP}"
        spec = f"{{kind: bearing_kalman, form: {form}, distances: {guesses(seed)}, {told}}}"
        return [f"period={STEP}", EYE, f"estimator={spec}"]

    return Case("ishikawa1994/estimation-ekf", settings, 2)


def odometry(along: float, turn: float, step: float) -> str:
    """Noise in m per m and rad per m, drawn once a step (m), as an odometer's per root of the way."""
    return f"{{distance_noise: {along * step**0.5}, heading_noise: {turn * step**0.5}, turn_noise: 0}}"


def surveyed(seed: int) -> list[str]:
    """The full state in one filter, on a tricycle whose motion has noise."""
    spec = f"{{kind: bearing_survey, distances: {guesses(seed)}, distance_std: {DOUBT}"
    told = odometry(0.05, 0.1, STEP)
    return [f"period={STEP}", EYE, "plant.twist_noise=[0.05, 0.1]", f"estimator={spec}, odometry: {told}}}"]


def among_beacons(noise: float = 1.0) -> Callable[[int], list[str]]:
    """The filter of Slimane et al. on an ideal differential drive: azimuths of four beacons, LQR in the loop.

    noise: what it is told over what there is.
    """
    beacons = ", ".join(f"{{at: {at}}}" for at in ([4, 0.5], [-1, 4], [-4, -1], [1.5, -3.5]))
    spec = f"kind: ekf, initial_std: [0.02, 0.02, 0.02], azimuth: {{std: {0.01 * noise}}}, gate: null"
    start, told = "start_std: [0.02, 0.02, 0.02]", odometry(0.1 * noise, 0.2 * noise, 0.025)
    settings = [
        "period=0.05", "duration=10", "robot=diffdrive", "controller=lqr",
        "reference={kind: circle, speed: 0.5, radius: 2}",
        "sensors={eye: {kind: bearing, rate: 5, noise: 0.01, latency: 0}}",
        f"plant={{kind: kinematic, {start}, twist_noise: [0.1, 0.2], beacons: [{beacons}]}}",
        f"estimator={{{spec}, inflation: null, odometry: {told}}}",
    ]  # fmt: skip
    return lambda _: settings


CASES = {
    "bui2022: ranges and bearings": Case("bui2022/ekf", lambda _: ["duration=32"], 4),
    "ishikawa1994: Kalman-Bucy": sights("bucy"),
    "ishikawa1994: sampled": sights("sampled"),
    "ishikawa1994: full state": Case("ishikawa1994/estimation-ekf", surveyed, 2),
    "slimane2014: azimuths": Case("pliego2023/circle", among_beacons(), 4),
}


def runs(case: Case, count: int) -> list[Ran]:
    """The case over so many seeds."""
    return [ran(case.scenario, "criteria={}", *case.settings(seed), seed=seed) for seed in range(count)]


def doubted(run: Ran) -> Array:
    """NEES of the pose at each step in which there is a covariance."""
    signals = run.signals
    values = nees(pose_error(signals["estimate"], signals["truth"]), signals["covariance"])
    return values[1:]


def surprises(run: Ran) -> Array:
    """NIS of all readings of one exposure together."""
    t, value = run.signals["nis/t"], run.signals["nis/value"]
    return np.array([value[t == moment].sum() for moment in np.unique(t)])


def inside(values: list[Array], dof: int) -> float:
    """The share of the steps in which the mean over the runs is within its bounds."""
    low, high = mean_bounds(dof, len(values))
    mean = np.mean(values, axis=0)
    return float(np.mean((mean > low) & (mean < high)))


@pytest.mark.parametrize("name", CASES)
def test_it_is_as_good_as_it_says_over_50_seeds(name: str) -> None:
    case = CASES[name]
    done = runs(case, RUNS)
    assert inside([doubted(run) for run in done], 3) >= 0.9
    assert inside([surprises(run) for run in done], case.readings) >= 0.9


@pytest.mark.parametrize("noise", [0.7, 1.4])
def test_a_filter_that_is_told_wrong_is_found_out(noise: float) -> None:
    done = runs(Case("pliego2023/circle", among_beacons(noise), 4), 15)
    assert inside([doubted(run) for run in done], 3) < 0.5
    assert inside([surprises(run) for run in done], 4) < 0.5


def test_the_papers_own_tuning_doubts_far_too_much_and_says_so() -> None:
    """Q = 1e3 m²/m beside bearings that are exact: NEES far below its 3."""
    run = ran("ishikawa1994/estimation-ekf", "criteria={}")
    assert 0 < doubted(run)[2000:].max() < 0.1
    assert run.verdict["metrics"]["nees_mean"] < 1.0
