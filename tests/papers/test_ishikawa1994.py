"""Figures 3 to 5 of Ishikawa & Sampei (1994): z = ±t, cycle 1 ms, beside integrations by scipy."""

from __future__ import annotations

from math import atan, cos, pi, sin, tan

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hilbed.angles import wrap
from hilbed.control.path_following import PathFollowing, PathFollowingSpec
from hilbed.control.steered import Steered
from hilbed.estimation.bearing_specs import (
    BearingKalmanSpec,
    BearingsSpec,
    LuenbergerSpec,
    LyapunovObserverSpec,
)
from hilbed.estimation.bearings import Bearings
from hilbed.estimation.sights import angle, sight
from hilbed.plant.kinematic import Vehicle
from hilbed.plant.kinematics import rk4
from hilbed.ports import Controller
from hilbed.robots.tricycle import Tricycle, TricycleSpec
from hilbed.types import Array, Command, Estimate, Pose, Reading
from tests.papers.ideal import Experiment, Known, Run, pose_sensor, run

MS = 1_000_000
TRICYCLE = Tricycle(TricycleSpec(max_steering=1.5, max_speed=2.0))
VEHICLE = Vehicle(TRICYCLE.twist, TRICYCLE.limited, integrator=rk4)
FORWARD = Experiment(VEHICLE, Pose(1.0, 2.0, -0.5), MS, 3000 * MS)
REVERSE = Experiment(VEHICLE, Pose(3.0, 1.0, -0.8), MS, 5000 * MS)
POSITIONS = (0.0, 0.0), (0.0, 1.0)
OBSERVERS: list[BearingsSpec] = [
    LyapunovObserverSpec(epsilon_2=2.0e-4),
    BearingKalmanSpec(),
    BearingKalmanSpec(form="sampled"),
    LuenbergerSpec(),
]


def bearings(t: int, pose: Pose) -> list[Reading]:
    return [
        Reading("azimuth", t, t, (angle(sight(pose, landmark).phi),), (1e-3,), k)
        for k, landmark in enumerate(POSITIONS)
    ]


class Straight:
    def step(self, t: int, estimate: Estimate) -> Command:  # noqa: ARG002
        return Command(1.0, 0.0)


def estimated(spec: BearingsSpec, experiment: Experiment, controller: Controller) -> Run:
    return run(experiment, Bearings(spec, Pose(0.0, 0.0, 0.0)), controller, bearings)


def distances(result: Run) -> Array:
    """l̂ over the run (m)."""
    return np.array([estimate.landmark_distance for estimate in result.estimates])


def errors(result: Run) -> Array:
    """|error| of x, y, θ (wrapped) and l over the run."""
    error = result.mean - result.truth
    error[:, 2] = (error[:, 2] + pi) % (2 * pi) - pi
    return np.abs(np.column_stack((error, distances(result) - 1.0)))


@pytest.mark.parametrize("spec", OBSERVERS, ids=lambda spec: f"{spec.kind}-{getattr(spec, 'form', '')}")
def test_figures_3_and_4_every_estimate_converges(spec: BearingsSpec) -> None:
    left = errors(estimated(spec, FORWARD, Straight()))
    assert left[0].max() > 0.5  # r̂_A starts at 1 m, not √5 m
    assert left[2000].max() < 2e-4


def test_figures_3_and_4_as_printed_the_lyapunov_observer_is_still_off_at_the_end() -> None:
    left = errors(estimated(LyapunovObserverSpec(), FORWARD, Straight()))
    assert left[-1, 1] > 0.3


S = np.arange(0, 1.0005, 1e-3)  # m, of one run of Fig. 3 at each cycle
X, Y = 1.0 + S * cos(-0.5), 2.0 + S * sin(-0.5)
PHI = [-0.5 - np.arctan2(Y - ay, X - ax) for ax, ay in POSITIONS]


def lyapunov_rates(s: float, x: Array) -> list[float]:
    """Both Lyapunov observers from the equations as mended; φ as it is at each moment."""
    px, py = 1.0 + s * cos(-0.5), 2.0 + s * sin(-0.5)
    rates = []
    for (r, phi), (ax, ay) in zip((x[:2], x[2:]), POSITIONS, strict=True):
        m = -0.5 - np.arctan2(py - ay, px - ax)
        scale = 4.0 * (m - phi) / (4 * (2.0e-4 - 1.0e-4) * r**2)
        rates += [cos(m) + np.sign(sin(m)) * scale, -sin(m) / r + 2.0e-2 * scale]
    return rates


def test_figures_3_and_4_are_near_those_of_bearings_without_cycles() -> None:
    """x̂, ŷ, l̂ by (8) from r̂ of scipy and the measured angles."""
    spec = LyapunovObserverSpec(epsilon_2=2.0e-4)
    result = estimated(spec, FORWARD._replace(duration=1000 * MS), Straight())
    rows = [np.array((1.0, PHI[0][0], 2**0.5, PHI[1][0]))]
    for s in S[:-1]:
        step = solve_ivp(lyapunov_rates, (s, s + 1e-3), rows[-1], rtol=1e-9, atol=1e-11)
        rows.append(step.y[:, -1])
    a, b = np.array(rows).T[[0, 2]]
    between = PHI[1] - PHI[0]
    l = np.sqrt(a**2 + b**2 - 2 * a * b * np.cos(between))  # noqa: E741
    expected = np.column_stack((a * b * np.sin(between) / l, (a**2 - a * b * np.cos(between)) / l, l))
    np.testing.assert_allclose(np.column_stack((result.mean[:, :2], distances(result))), expected, atol=3e-5)


@pytest.mark.parametrize("speed", [1.0, -1.0])
@pytest.mark.parametrize("yaw", [0.6, -0.8, pi - 0.5])
def test_state_feedback_has_its_closed_form(speed: float, yaw: float) -> None:
    """e over the way along the line is (a + b x) exp(−2x) with both poles at −2, in either direction."""
    law = Steered(PathFollowing(PathFollowingSpec(speed=speed)), TRICYCLE)
    experiment = Experiment(VEHICLE, Pose(3.0, 1.0, yaw), MS, 3000 * MS)
    truth = run(experiment, Known(), law, pose_sensor).truth
    x, e = np.abs(truth[:, 0] - 3.0), truth[:, 1] - 1.5
    slope = np.copysign(1, cos(yaw) * speed) * tan(yaw)  # de/dx at the start, x counted along the travel
    np.testing.assert_allclose(e, (-0.5 + (slope - 1.0) * x) * np.exp(-2 * x), atol=2e-3)
    assert abs(e[-1]) < 0.03


@pytest.mark.parametrize("speed", [1.0, -1.0])
def test_state_feedback_equals_an_integration_with_the_input_held(speed: float) -> None:
    """(21) as printed, in z: F₂ = −4 ahead and +4 backwards; steering held over the cycle."""
    law = Steered(PathFollowing(PathFollowingSpec(speed=speed)), TRICYCLE)
    experiment = Experiment(VEHICLE, Pose(3.0, 1.0, -0.8), MS, 1000 * MS)
    result = run(experiment, Known(), law, pose_sensor)
    state = np.array((3.0, 1.0, -0.8))
    for k in range(1000):
        u = cos(state[2]) ** 3 * (-4.0 * (state[1] - 1.5) - 4.0 * speed * tan(state[2]))
        assert result.command[k] == pytest.approx((speed, atan(u)), abs=1e-6)
        rates = lambda _, p, u=u: (cos(p[2]), sin(p[2]), u)  # noqa: E731
        state = solve_ivp(rates, (0, speed * 1e-3), state, rtol=1e-10, atol=1e-12).y[:, -1]
    np.testing.assert_allclose(result.truth[-1], state, atol=1e-6)


@pytest.mark.parametrize("spec", OBSERVERS[1:], ids=lambda spec: f"{spec.kind}-{getattr(spec, 'form', '')}")
def test_figure_5_reverse_along_the_line_fed_by_an_observer(spec: BearingsSpec) -> None:
    law = Steered(PathFollowing(PathFollowingSpec(speed=-1.0)), TRICYCLE)
    result = estimated(spec, REVERSE, law)
    assert result.truth[-1, 0] < 0.0  # it has passed both landmarks, backwards
    assert abs(result.truth[-1, 1] - 1.5) < 5e-3
    assert abs(result.truth[-1, 2]) < 2e-2


@pytest.mark.parametrize("seed", range(3))
def test_figure_5_with_a_cameras_bearings(seed: int) -> None:
    """Ten a second, 2 mrad, 40 ms late, by the extended Luenberger observer with its floor."""
    rng, coming = np.random.default_rng(seed), list[Reading]()

    def camera(t: int, pose: Pose) -> list[Reading]:
        if t % (100 * MS) == 0:
            coming.extend(
                r._replace(value=(wrap(r.value[0] + rng.normal(0, 2e-3)),), delivered=t + 40 * MS)
                for r in bearings(t, pose)
            )
        due = [r for r in coming if r.delivered <= t]
        del coming[: len(due)]
        return due

    law = Steered(PathFollowing(PathFollowingSpec(speed=-1.0)), TRICYCLE)
    estimator = Bearings(LuenbergerSpec(), REVERSE.start)
    truth = run(REVERSE._replace(period=10 * MS), estimator, law, camera).truth
    assert np.abs(truth[300:, 1] - 1.5).max() < 0.08


def test_a_differential_drive_follows_the_line_too() -> None:
    law = PathFollowing(PathFollowingSpec(speed=-1.0))
    result = estimated(
        LuenbergerSpec(), REVERSE._replace(vehicle=Vehicle(lambda u: (u.v, u.w), integrator=rk4)), law
    )
    assert abs(result.truth[-1, 1] - 1.5) < 5e-3


def test_square_to_the_line_the_law_does_nothing_and_says_so() -> None:
    law = PathFollowing(PathFollowingSpec())
    command = law.step(0, Estimate(0, np.array((0.0, 0.0, pi / 2)), np.zeros((3, 3))))
    assert command == pytest.approx((1.0, 0.0), abs=1e-12)
    assert law.beyond == 1
