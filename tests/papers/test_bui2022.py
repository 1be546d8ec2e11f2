"""Tests 1 to 3, open and closed loop, and localisation of Bui & Duong (2022): cycle 0.1 s, exact arcs."""

from __future__ import annotations

from collections.abc import Callable
from math import atan2, hypot, pi, sin, tan

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hilbed.angles import wrap
from hilbed.control.legs import LegsSpec
from hilbed.control.lyapunov_spec import LyapunovTrackingSpec
from hilbed.control.lyapunov_tracking import LyapunovTracking
from hilbed.control.open_loop import OpenLoop
from hilbed.control.ramps import Ramps, RampSpec, RampsSpec
from hilbed.control.steered import Steered
from hilbed.estimation.consistency import pose_error
from hilbed.estimation.dead_reckoning import DeadReckoning
from hilbed.estimation.ekf import Ekf
from hilbed.estimation.specs import DeadReckoningSpec, EkfSpec, OdometrySpec
from hilbed.plant.kinematic import Vehicle
from hilbed.ports import Controller, Estimator
from hilbed.robots.tricycle import Tricycle, TricycleSpec
from hilbed.types import Array, Command, Pose, Reading
from tests.papers.ideal import Experiment, Known, Run, pose_sensor, run

PERIOD, NS = 100_000_000, 10**9
REFERENCE = LegsSpec().build()
ORIGIN = Pose(0.0, 0.0, 0.0)
TESTS = {  # v and γ over time, as printed but for the unit of γ
    1: RampsSpec(speed=RampSpec(start=1.0), steering=RampSpec(start=pi / 6)),
    2: RampsSpec(speed=RampSpec(start=1.0), steering=RampSpec(rate=0.5)),
    3: RampsSpec(speed=RampSpec(rate=0.2), steering=RampSpec(rate=0.5)),
}
TYPES = {1: "front", 2: "rear"}


def tricycle(kind: int) -> Tricycle:
    return Tricycle(TricycleSpec.model_validate({"drive": TYPES[kind], "max_speed": 1.68}))


def printed(v: float, γ: float, kind: int) -> tuple[float, float]:
    """Speed and yaw rate by (2.3) or (2.4), d = 1 m."""
    return (v * np.cos(γ), v * sin(γ)) if kind == 1 else (v, v * tan(γ))


def driven(test: int, kind: int, period: int = PERIOD) -> Run:
    robot = tricycle(kind)
    experiment = Experiment(Vehicle(robot.twist, robot.limited), ORIGIN, period, 10 * NS)
    return run(experiment, Known(), Ramps(TESTS[test]), pose_sensor)


@pytest.mark.parametrize("kind", [1, 2])
@pytest.mark.parametrize("test", [1, 2, 3])
def test_final_poses_are_sums_of_arcs(test: int, kind: int) -> None:
    """Each 0.1 s an arc of radius v/w: its chord and its turn, added up."""
    spec, pose, yaw = TESTS[test], 0j, 0.0
    for k in range(100):
        v = min(spec.speed.start + spec.speed.rate * 0.1 * k, 1.68)
        γ = min(spec.steering.start + spec.steering.rate * 0.1 * k, pi / 4)
        speed, w = printed(v, γ, kind)
        chord = 2 * speed / w * sin(0.05 * w) if w else 0.1 * speed
        pose += chord * np.exp(1j * (yaw + 0.05 * w))
        yaw += 0.1 * w
    end = driven(test, kind).truth[-1]
    assert end == pytest.approx((pose.real, pose.imag, wrap(yaw)), abs=1e-9)


@pytest.mark.parametrize(("kind", "yaw"), [(1, 5.0), (2, 10 / 3**0.5)])
def test_test_1_is_a_circle_in_closed_form(kind: int, yaw: float) -> None:
    """R = d/tan γ = √3 m for either type; the headings differ, against the text."""
    R = 3**0.5
    truth = driven(1, kind).truth
    assert np.hypot(truth[:, 0], truth[:, 1] - R) == pytest.approx(R)
    assert truth[-1] == pytest.approx((R * sin(yaw), R * (1 - np.cos(yaw)), wrap(yaw)))


@pytest.mark.parametrize("kind", [1, 2])
@pytest.mark.parametrize("test", [2, 3])
def test_radius_at_the_steering_limit_is_the_wheelbase(test: int, kind: int) -> None:
    """From t = π/2 s the angle stays at π/4: R = d / tan(π/4) = 1 m."""
    x, y, _ = driven(test, kind).truth[20:].T
    A = np.column_stack((2 * x, 2 * y, np.ones_like(x)))
    a, b, c = np.linalg.lstsq(A, x * x + y * y, rcond=None)[0]
    assert np.sqrt(c + a * a + b * b) == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize("kind", [1, 2])
@pytest.mark.parametrize("test", [2, 3])
def test_with_short_cycles_the_ramps_are_the_continuous_ones(test: int, kind: int) -> None:
    spec = TESTS[test]

    def rates(t: float, p: Array) -> list[float]:
        v = min(spec.speed.start + spec.speed.rate * t, 1.68)
        speed, w = printed(v, min(0.5 * t, pi / 4), kind)
        return [speed * np.cos(p[2]), speed * np.sin(p[2]), w]

    end = solve_ivp(rates, (0, 10), ORIGIN, max_step=0.01, rtol=1e-9).y[:, -1]
    ours = driven(test, kind, PERIOD // 100).truth[-1]
    assert ours[:2] == pytest.approx(end[:2], abs=2e-3)
    assert wrap(ours[2] - end[2]) == pytest.approx(0.0, abs=2e-3)


def test_tests_2_and_3_type_1_have_a_heading_in_closed_form() -> None:
    """θ = ∫ v sin γ dt: (1 − cos π/4)/0.5 + (10 − π/2) sin π/4 in test 2, over short cycles."""
    expected = (1 - np.cos(pi / 4)) / 0.5 + (10 - pi / 2) * sin(pi / 4)
    assert wrap(driven(2, 1, PERIOD // 100).truth[-1, 2] - expected) == pytest.approx(0.0, abs=2e-3)


def tracked(controller: Controller, start: Pose, noise: float, seed: int = 0) -> Run:
    """Steering noise of a standard deviation (rad), held over each step, then limited to ±π/4."""
    robot, rng = Tricycle(TricycleSpec()), np.random.default_rng(seed)
    vehicle = Vehicle(robot.twist, robot.limited, lambda c: Command(c[0], c[1] + rng.normal(0.0, noise)))
    steered = Steered(controller, robot)
    return run(Experiment(vehicle, start, PERIOD, 50 * NS), Known(), steered, pose_sensor)


def off(result: Run) -> Array:
    """Distance (m) from the reference over the run."""
    wanted = np.array([REFERENCE.at(k * PERIOD).pose for k in range(501)])
    return np.asarray(np.hypot(*(result.truth - wanted)[:, :2].T))


def test_open_loop_without_noise_stays_on_the_reference() -> None:
    assert off(tracked(OpenLoop(REFERENCE), Pose(-20.0, 4.0, 0.0), 0.0)).max() < 1e-9


def test_open_loop_with_steering_noise_strays() -> None:
    ends = [off(tracked(OpenLoop(REFERENCE), Pose(-20.0, 4.0, 0.0), 0.3, seed))[-1] for seed in range(5)]
    assert np.median(ends) > 2.0


def lyapunov() -> LyapunovTracking:
    return LyapunovTracking(LyapunovTrackingSpec(), REFERENCE)


def test_closed_loop_comes_to_the_reference() -> None:
    result = tracked(lyapunov(), Pose(-20.0, 3.0, 0.0), 0.0)
    left = off(result)
    assert left[0] == pytest.approx(1.0)
    assert left[190] < 0.02
    assert left[-1] < 0.02
    assert abs(result.command[:, 1]).max() <= pi / 4


@pytest.mark.parametrize("seed", range(5))
def test_closed_loop_with_steering_noise_oscillates_round_the_reference(seed: int) -> None:
    left = off(tracked(lyapunov(), Pose(-20.0, 3.0, 0.0), 0.3, seed))
    assert left[200:].max() < 0.6


LANDMARKS = [(-10.0, 10.0), (-8.0, -10.0)]  # free
RANGE_STD, BEARING_STD = 0.1, 0.02  # m, rad, free
STEERING_STD = 0.05  # rad
STEP = 0.04 * pi  # m, one cycle of the half circle; there tan γ = d/4 m
CURVE = (STEP * 17 / 16) ** 2  # variance of the turn a step and rad² of steering: (v T / (d cos² γ))²
NOISE = OdometrySpec(  # the same per root of the way and of the turn; on the lines (0.1 m)² is all there is
    distance_noise=1e-9,
    heading_noise=0.1**0.5 * STEERING_STD,
    turn_noise=((CURVE - 0.1 * STEP) / (0.01 * pi)) ** 0.5 * STEERING_STD,
)


def sighting(rng: np.random.Generator) -> Callable[[int, Pose], list[Reading]]:
    def readings(t: int, pose: Pose) -> list[Reading]:
        made = []
        for k, (x, y) in enumerate(LANDMARKS):
            dx, dy = x - pose.x, y - pose.y
            r = hypot(dx, dy) + rng.normal(0, RANGE_STD)
            β = wrap(atan2(dy, dx) - pose.yaw + rng.normal(0, BEARING_STD))
            made.append(Reading("range", t, t, (r,), (RANGE_STD,), k))
            made.append(Reading("azimuth", t, t, (β,), (BEARING_STD,), k))
        return made

    return readings


INITIAL = (0.1, 0.1, 0.05)


def localised(seed: int, kind: str) -> Array:
    """Drives the reference in open loop with steering noise; error (N, 3)."""
    robot, rng = Tricycle(TricycleSpec()), np.random.default_rng(seed)
    vehicle = Vehicle(
        robot.twist, robot.limited, lambda c: Command(c[0], c[1] + rng.normal(0.0, STEERING_STD))
    )
    start = Pose(-20.0, 4.0, 0.0)
    guess = Pose(*(np.array(start) + rng.normal(0, INITIAL)))
    estimator: Estimator
    if kind == "ekf":
        spec = EkfSpec(initial_std=INITIAL, odometry=NOISE, gate=None, inflation=None)
        estimator = Ekf(spec, LANDMARKS, guess)
    else:
        estimator = DeadReckoning(DeadReckoningSpec(initial_std=INITIAL, odometry=NOISE), guess)
    experiment = Experiment(vehicle, start, PERIOD, 49 * NS)
    law = Steered(OpenLoop(REFERENCE), robot)
    result = run(experiment, estimator, law, sighting(rng))
    return pose_error(result.mean, result.truth)


def test_the_filter_with_a_tricycles_odometry_beats_dead_reckoning() -> None:
    """Fig. 4.1, 4.2: the filter that a differential drive uses."""
    filtered, reckoned = localised(1, "ekf"), localised(1, "odometry")
    assert np.abs(filtered[50:, :2]).max() < 0.2
    assert np.abs(reckoned[:, :2]).max() > 5 * np.abs(filtered[50:, :2]).max()
    assert np.abs(filtered[50:, 2]).max() < 0.06
