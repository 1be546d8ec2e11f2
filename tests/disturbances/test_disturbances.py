"""Every disturbance does what it says, from its start to its end and nowhere else."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed.clock import nanos
from hilbed.disturbances import DISTURBANCES, DisturbanceSpec
from hilbed.disturbances.bodies import FASTEST, Push, SlipPatch, WheelRadius
from hilbed.disturbances.commands import CommandNoise, DisturbedBase
from hilbed.disturbances.drives import IMPULSE_LENGTH, LoadTorque, SupplySag
from hilbed.disturbances.schedule import Schedule
from hilbed.disturbances.vision import CameraLoss, SpuriousAzimuths
from hilbed.effects import Effects
from hilbed.types import Command, Nanos, Odometry, Pose

DRIVES = ("left", "right")


class Place:
    """Where the robot is: `Surroundings` that a test moves about."""

    def __init__(self, *wheels: tuple[float, float]) -> None:
        self.pose = Pose(0.0, 0.0, 0.0)
        self.wheels: Sequence[tuple[float, float]] = wheels or [(0.0, 0.2), (0.0, -0.2)]


def schedule(*specs: DisturbanceSpec, seed: int = 0) -> Schedule:
    entries = []
    for spec in specs:
        wheel = DRIVES.index(getattr(spec, "drive", "left"))
        entries.append((spec, DISTURBANCES[spec.kind](spec, wheel, np.random.default_rng(seed))))
    return Schedule(entries, Effects([0.8, 0.8]))


def state(effects: Effects) -> tuple[object, ...]:
    e = effects
    return (
        tuple(e.load_torque), tuple(e.friction), tuple(e.radius), e.push, e.supply_drop, e.spurious, e.blind,
        e.command,
    )  # fmt: skip


REST = state(Effects([0.8, 0.8]))


@pytest.mark.parametrize(
    ("spec", "name", "value"),
    [
        (LoadTorque(drive="right", start=1, length=2, size=3), "load_torque", [0.0, 3.0]),
        (WheelRadius(drive="left", start=1, length=2, size=0.98), "radius", [0.98, 1.0]),
        (Push(start=1, length=2, size=(3, -4), torque=5), "push", (3.0, -4.0, 5.0)),
        (SupplySag(start=1, length=2, size=6), "supply_drop", 6.0),
        (SpuriousAzimuths(start=1, length=2, size=0.3), "spurious", 0.3),
        (CameraLoss(start=1, length=2), "blind", True),
        (SlipPatch(start=1, length=2, corner=(-1, 0), opposite=(1, 1), friction=0.1), "friction", [0.1, 0.8]),
    ],
)  # fmt: skip
def test_it_acts_between_its_start_and_its_end_only(spec: DisturbanceSpec, name: str, value: object) -> None:
    plan, seen = schedule(spec), []
    for t in range(0, nanos(4.0), nanos(0.001)):
        plan.apply(t, Place())
        seen.append(state(plan.effects) != REST)
        if t == nanos(1.5):
            assert getattr(plan.effects, name) == value
    acting = np.flatnonzero(seen)
    assert (acting[0], acting[-1]) == (1000, 2999)
    assert len(acting) == 2000


def test_without_a_length_it_lasts() -> None:
    plan = schedule(SupplySag(start=1, size=2))
    plan.apply(nanos(1e6), Place())
    assert plan.effects.supply_drop == 2


def test_a_ramp_rises_linearly_and_stays() -> None:
    plan = schedule(LoadTorque(drive="left", start=1, size=4, shape="ramp", rise=2))
    seen = {}
    for t in (0.5, 1.0, 2.0, 2.5, 3.0, 9.0):
        plan.apply(nanos(t), Place())
        seen[t] = plan.effects.load_torque[0]
    assert seen == pytest.approx({0.5: 0, 1.0: 0, 2.0: 2, 2.5: 3, 3.0: 4, 9.0: 4})


def test_an_impulse_without_a_length_is_short_and_may_be_given_one() -> None:
    assert (
        LoadTorque.model_validate({"drive": "left", "size": 1, "shape": "impulse"}).length == IMPULSE_LENGTH
    )
    given = {"drive": "left", "size": 1, "shape": "impulse", "length": 0.1}
    assert LoadTorque.model_validate(given).length == 0.1


def test_disturbances_of_one_kind_add_up() -> None:
    plan = schedule(
        *[LoadTorque(drive="left", size=size) for size in (1, 2)], WheelRadius(drive="left", size=0.9)
    )
    plan.apply(0, Place())
    assert plan.effects.load_torque == [3.0, 0.0]
    assert plan.effects.radius == [0.9, 1.0]


@given(st.floats(-3, 3), st.floats(-FASTEST, FASTEST), st.integers(0, 2000))
def test_a_patch_is_never_missed_by_being_asked_seldom(x: float, speed: float, ticks: int) -> None:
    """The schedule skips ticks while no wheel can reach the edge; what it then says is still exact."""
    plan = schedule(SlipPatch(corner=(0, -1), opposite=(1, 1), friction=0.05))
    place = Place()
    for k in range(ticks):
        at = x + speed * 0.001 * k
        place.wheels = [(at, 0.2), (at, -0.2)]
        plan.apply(k * 1_000_000, place)
        inside = 0 <= at <= 1
        assert plan.effects.friction == ([0.05, 0.05] if inside else [0.8, 0.8])


def test_a_spread_is_drawn_once_a_run_from_the_seed() -> None:
    spec = WheelRadius(drive="left", size=1.0, spread=0.01)
    sizes = []
    for seed in (1, 1, 2):
        plan = schedule(spec, seed=seed)
        plan.apply(0, Place())
        sizes.append(plan.effects.radius[0])
    assert sizes[0] == sizes[1] != sizes[2]
    assert abs(sizes[0] - 1.0) < 0.05


NOISE = CommandNoise(start=1, length=100, size=(0.02, 0.3), hold=0.1)


def noise(spec: CommandNoise, step: float, seed: int = 0) -> np.ndarray:
    """What is added to the command (N, 2), asked every `step` s from the start to the end."""
    plan, seen = schedule(spec, seed=seed), []
    for t in range(nanos(spec.start), nanos(spec.start + (spec.length or 0.0)), nanos(step)):
        plan.apply(t, Place())
        seen.append(plan.effects.command)
    return np.array(seen)


def test_noise_on_the_command_is_held_and_has_its_spread() -> None:
    """0.3 rad on the steering angle, a draw for each 0.1 s: variance 0.09 rad², Bui & Duong (2022)."""
    seen = noise(NOISE, 0.01).reshape(1000, 10, 2)
    assert (seen == seen[:, :1]).all()
    draws = seen[:, 0]
    assert len(np.unique(draws[:, 1])) == 1000
    assert draws.std(axis=0) == pytest.approx((0.02, 0.3), rel=0.08)  # 3.5 σ of a standard deviation of 1000
    assert abs(draws.mean(axis=0) / (0.02, 0.3)).max() < 0.11
    assert abs(np.corrcoef(draws[1:, 1], draws[:-1, 1])[0, 1]) < 0.11


def test_noise_on_the_command_is_the_seeds_however_often_it_is_asked() -> None:
    assert np.array_equal(noise(NOISE, 0.1), noise(NOISE, 0.02)[::5])
    assert not np.array_equal(noise(NOISE, 0.1), noise(NOISE, 0.1, seed=1))


class Told:
    """A base that keeps what it is told."""

    def __init__(self) -> None:
        self.commands: list[Command] = []

    def read(self, t: Nanos) -> Odometry:
        return Odometry(t, 0.0, 0.0, 0.0, 0.0)

    def write(self, t: Nanos, command: Command) -> None:  # noqa: ARG002
        self.commands.append(command)


def test_a_disturbed_command_keeps_to_the_robots_limits() -> None:
    """First without noise, when what the controller asks for is nobody's affair; then added, then limited."""
    told, effects = Told(), Effects(())
    base = DisturbedBase(told, lambda c: Command(min(c.v, 1.0), min(c.w, 0.5)), lambda _: effects)
    base.write(0, Command(3.0, 0.6))
    effects.command = (0.1, -0.2)
    base.write(1, Command(0.5, 0.3))
    effects.command = (0.1, 0.3)
    base.write(2, Command(0.5, 0.3))
    assert told.commands == [(3.0, 0.6), pytest.approx((0.6, 0.1)), (0.6, 0.5)]
    assert base.read(7).t == 7
