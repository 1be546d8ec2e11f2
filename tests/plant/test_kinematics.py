from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError
from scipy.integrate import solve_ivp

from hilbed.angles import wrap
from hilbed.plant.kinematic import IdealBase, KinematicPlant, Vehicle
from hilbed.plant.kinematic_spec import KinematicSpec, make_vehicle
from hilbed.plant.kinematics import INTEGRATORS, TwistNoise, advanced, euler, exact, rk4
from hilbed.types import Array, Command, Pose

poses = st.builds(Pose, st.floats(-9, 9), st.floats(-9, 9), st.floats(-pi, pi))
speeds, turn_rates = st.floats(-3, 3), st.floats(-4, 4)
times = st.floats(1e-3, 2.0)


def integrated(pose: Pose, twist: tuple[float, float], T: float) -> Array:
    """The unicycle's equations by scipy; the yaw is not wrapped."""
    v, w = twist
    rates = lambda _, p: (v * cos(p[2]), v * sin(p[2]), w)  # noqa: E731
    ends: Array = solve_ivp(rates, (0, T), pose, method="DOP853", rtol=1e-12, atol=1e-12).y[:, -1]
    return ends


def distance(a: Pose, b: Array) -> float:
    return max(abs(a.x - b[0]), abs(a.y - b[1]), abs(wrap(a.yaw - b[2])))


@given(poses, speeds, turn_rates, times)
def test_exact_arcs_equal_an_integration(pose: Pose, v: float, w: float, T: float) -> None:
    assert distance(exact(pose, (v, w), T), integrated(pose, (v, w), T)) < 1e-9


@given(poses, speeds, st.floats(-1e-3, 1e-3), times)
def test_nearly_straight_arcs_are_exact_too(pose: Pose, v: float, w: float, T: float) -> None:
    assert distance(exact(pose, (v, w), T), integrated(pose, (v, w), T)) < 1e-9


@given(poses, speeds, turn_rates, times, st.integers(2, 5))
def test_an_arc_cut_in_parts_is_the_same_arc(pose: Pose, v: float, w: float, T: float, parts: int) -> None:
    whole, cut = exact(pose, (v, w), T), advanced(pose, (v, w), T, exact, parts)
    assert distance(whole, np.array(cut)) < 1e-9


@given(poses, speeds, turn_rates, times)
def test_backwards_undoes_forwards(pose: Pose, v: float, w: float, T: float) -> None:
    assert distance(exact(exact(pose, (v, w), T), (-v, -w), T), np.array(pose)) < 1e-9


@pytest.mark.parametrize(("name", "order"), [("euler", 1), ("rk4", 4)])
def test_integrators_have_their_order(name: str, order: int) -> None:
    """Halving the step divides the error by 2^order."""
    pose, twist, T = Pose(1.0, -2.0, 0.3), (1.3, 0.9), 2.0
    truth = integrated(pose, twist, T)
    coarse, fine = (distance(advanced(pose, twist, T, INTEGRATORS[name], n), truth) for n in (8, 16))
    assert np.log2(coarse / fine) == pytest.approx(order, abs=0.15)


def test_standing_and_turning_on_the_spot() -> None:
    pose = Pose(1.0, 2.0, 3.0)
    for move in (exact, rk4, euler):
        assert move(pose, (0.0, 0.0), 1.0) == pose
        turned = move(pose, (0.0, 1.0), 1.0)
        assert turned == pytest.approx((1.0, 2.0, wrap(4.0)))


def test_noise_is_in_proportion_to_the_speed() -> None:
    rng = np.random.default_rng(1)
    noise = TwistNoise(0.005, 0.1745)
    draws = np.array([noise.disturbed((0.4, 0.1), rng) for _ in range(20000)])
    assert draws.mean(axis=0) == pytest.approx((0.4, 0.1), abs=2e-3)
    assert draws.std(axis=0) == pytest.approx((0.4 * 0.005, 0.4 * 0.1745), rel=0.03)
    assert noise.disturbed((0.0, 0.1), rng) == (0.0, 0.1)


def test_the_plant_is_disturbed_within_its_limits_and_its_base_sees_none_of_it() -> None:
    def limited(command: Command) -> Command:
        return Command(min(command[0], 0.5), command[1])

    vehicle = Vehicle(
        twist=tuple,
        limited=limited,
        command_noise=lambda c: Command(c[0] + 0.2, c[1]),
        twist_noise=lambda t: t,
    )
    plant = KinematicPlant(Pose(0.0, 0.0, 0.0), vehicle)
    base = IdealBase(plant, vehicle)
    assert base.read(0)[:5] == (0, 0.0, 0.0, 0.0, 0.0)
    base.write(0, Command(0.4, 0.0))
    plant.advance(0, 10**9)
    assert plant.truth() == (10**9, (0.5, 0.0, 0.0))
    assert base.read(10**9)[:5] == (10**9, 0.4, 0.0, 0.4, 0.0)


def test_a_block_makes_the_plant_it_describes() -> None:
    """Noise on the command is held over the period, limited after it, and the same for the same stream."""
    spec = KinematicSpec(integrator="rk4", steps=4, command_noise=(0.0, 0.3), twist_noise=(0.005, 0.1745))

    def ends(seed: int) -> Pose:
        vehicle = make_vehicle(
            spec, tuple, lambda c: Command(c[0], min(max(c[1], -0.1), 0.1)), np.random.default_rng(seed)
        )
        assert (vehicle.integrator, vehicle.steps) == (rk4, 4)
        plant = KinematicPlant(Pose(0.0, 0.0, 0.0), vehicle)
        plant.obey(Command(0.0, 0.0))
        for t in range(0, 1000, 10):
            plant.advance(t * 10**7, (t + 10) * 10**7)
        return plant.truth().pose

    assert ends(1) == ends(1) != ends(2)
    assert 0 < abs(ends(1).yaw) < 0.1 * 10
    with pytest.raises(ValidationError):
        KinematicSpec.model_validate({"integrator": "heun"})
