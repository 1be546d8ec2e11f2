"""Control with the observer in the loop, Pliego-Jiménez (2023), section 5, on an ideal unicycle."""

from __future__ import annotations

from math import cos, exp, hypot, pi, sin

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hilbed.control.front_point import FrontPoint, FrontPointSpec, front_point, front_point_twist
from hilbed.control.reference import CircleSpec, FigureEightSpec, PathReference
from hilbed.control.steered import Steered
from hilbed.estimation.attitude_estimator import Attitude
from hilbed.estimation.attitude_spec import AttitudeSpec
from hilbed.plant.kinematic import Vehicle
from hilbed.robots.tricycle import Tricycle, TricycleSpec
from hilbed.types import Array, Pose, Reading
from tests.papers.ideal import Experiment, Known, Run, pose_sensor, run

PERIOD = 10_000_000
CIRCLE = CircleSpec(kind="circle", radius=1.0, speed=0.3).build()
EIGHT = FigureEightSpec(kind="figure_eight", radius=0.8, speed=0.3).build()
SPEC = FrontPointSpec(ahead=0.1, gain=1.0, max_speed=3.0, max_turn_rate=30.0)
UNICYCLE = Vehicle(lambda command: (command.v, command.w))


def position(t: int, pose: Pose) -> list[Reading]:
    return [Reading("position", t, t, (pose.x, pose.y), (1e-3, 1e-3))]


def front_error(result: Run, reference: PathReference) -> Array:
    """|z − z_d| of the true front point over the run (m)."""
    rows = []
    for k, pose in enumerate(result.truth.tolist()):
        x, y = front_point(reference.at(k * PERIOD).pose, SPEC.ahead)
        zx, zy = front_point(tuple(pose), SPEC.ahead)
        rows.append(hypot(zx - x, zy - y))
    return np.array(rows)


def track(form: str, reference: PathReference, error: float, duration: float) -> Run:
    start = Pose(0.3, -1.2, -0.6)
    spec = AttitudeSpec.model_validate({"form": form, "gain": 20.0, "heading_error": error})
    experiment = Experiment(UNICYCLE, start, PERIOD, round(duration * 1e9))
    return run(experiment, Attitude(spec, start), FrontPoint(SPEC, reference), position)


@pytest.mark.parametrize("form", ["so2", "s1", "global"])
@pytest.mark.parametrize("reference", [CIRCLE, EIGHT], ids=["circle", "eight"])
@pytest.mark.parametrize("error", [2.5, -2.5])
def test_the_robot_comes_to_its_path_from_a_wrong_heading(
    form: str, reference: PathReference, error: float
) -> None:
    result = track(form, reference, error, 30.0)
    left = front_error(result, reference)
    assert left[0] > 0.2
    assert left[-500:].max() < 5e-3
    assert np.isfinite(result.mean).all()


def test_with_the_heading_known_the_error_decays_as_told() -> None:
    """|z − z_d| = |z₀ − z_d| exp(−k t), but for inputs that are held over a cycle."""
    start = Pose(0.3, -1.2, -0.6)
    law = FrontPoint(SPEC, CIRCLE)
    fine = run(Experiment(UNICYCLE, start, 1_000_000, 4 * 10**9), Known(), law, pose_sensor)
    t = np.arange(0, 4.0005, 1e-3)
    wanted = [front_point(CIRCLE.at(k * 1_000_000).pose, 0.1) for k in range(4001)]
    errors = [
        hypot(zx - dx, zy - dy)
        for (dx, dy), (zx, zy) in zip(
            wanted, (front_point(tuple(p), 0.1) for p in fine.truth.tolist()), strict=True
        )
    ]
    np.testing.assert_allclose(errors, errors[0] * np.exp(-t), atol=2e-3)
    assert errors[-1] < errors[0] * exp(-4) + 2e-3


def test_the_printed_loop_with_a_measured_front_point_and_so2_by_scipy() -> None:
    """Robot, R̂ and law in one system, continuous: our law with z measured, then the loop's convergence."""
    k, alpha, δ = 1.0, 20.0, 0.1

    def rates(t: float, x: Array) -> list[float]:
        yaw, guess = x[2], x[3]
        z = front_point((x[0], x[1], yaw), δ)
        d, v, _ = CIRCLE.at(round(t * 1e9))
        wanted = (v * cos(d.yaw) - k * (z[0] - d.x), v * sin(d.yaw) - k * (z[1] - d.y))
        ν, ω = front_point_twist(wanted, guess, δ)
        return [ν * cos(yaw), ν * sin(yaw), ω, ω + alpha * ν * ν * sin(yaw - guess)]

    x = solve_ivp(rates, (0, 20), (0.3, -1.2, -0.6, -3.1), rtol=1e-8, atol=1e-9, max_step=0.02).y[:, -1]
    z = front_point((x[0], x[1], x[2]), δ)
    d = CIRCLE.at(20 * 10**9).pose
    assert hypot(z[0] - d.x, z[1] - d.y) < 1e-3
    assert abs(sin(x[2] - x[3])) < 1e-3


def test_the_law_moves_the_front_point_as_wanted() -> None:
    """ż of (ν, ω), by differences."""
    yaw, δ, wanted, h = 0.7, 0.15, (0.3, -0.4), 1e-6
    ν, ω = front_point_twist(wanted, yaw, δ)
    before = front_point((0.0, 0.0, yaw), δ)
    after = front_point((h * ν * cos(yaw), h * ν * sin(yaw), yaw + h * ω), δ)
    assert ((after[0] - before[0]) / h, (after[1] - before[1]) / h) == pytest.approx(wanted, abs=1e-5)


def test_commands_are_limited() -> None:
    law = FrontPoint(FrontPointSpec(max_speed=0.5, max_turn_rate=2.0), CIRCLE)
    estimate = Known().step(0, None, pose_sensor(0, Pose(50.0, -80.0, 1.0)))
    v, w = law.step(0, estimate)
    assert abs(v) == 0.5
    assert abs(w) == 2.0


def test_a_tricycle_is_led_by_its_front_point_too() -> None:
    """Where its steering angle suffices: on the circle from a heading error of 0.3 rad."""
    robot = Tricycle(TricycleSpec(wheelbase=0.3, max_steering=1.2))
    spec = FrontPointSpec(ahead=0.3, gain=1.0)
    start = Pose(0.0, -1.1, 0.2)
    law = Steered(FrontPoint(spec, CIRCLE), robot)
    experiment = Experiment(Vehicle(robot.twist, robot.limited), start, PERIOD, 20 * 10**9)
    result = run(experiment, Attitude(AttitudeSpec(gain=20.0, heading_error=0.3), start), law, position)
    z = front_point(tuple(result.truth[-1].tolist()), 0.3)
    d = front_point(CIRCLE.at(20 * 10**9).pose, 0.3)
    assert hypot(z[0] - d[0], z[1] - d[1]) < 5e-3
    assert abs(result.command[:, 1]).max() <= 1.2 < pi / 2
