"""What every World does: it rolls as its wheels turn, slips where Coulomb says, ends where it must."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import hypot, pi
from typing import NamedTuple

import pytest

from hilbed.angles import wrap
from hilbed.cost import Cost
from hilbed.effects import Effects
from hilbed.plant.bullet import BulletWorld
from hilbed.plant.bullet_spec import BulletSpec
from hilbed.plant.bullet_tricycle import TricycleWorld
from hilbed.plant.urdf import Behind, Body, diffdrive
from hilbed.plant.urdf_tricycle import tricycle
from hilbed.ports import Robot
from hilbed.resources import package_file
from hilbed.robots import DiffDrive, DiffDriveSpec, Tricycle, TricycleSpec
from hilbed.types import Command, Diverged, Pose

RADIUS, TRACK, WHEELBASE = 0.1, 0.5, 0.8
BEHIND = Behind(0.0087, 0.0087)
HELD = 500.0  # N m: a steering axis that nothing turns
AT = Pose(1.0, -0.5, 0.6)


class Kind(NamedTuple):
    """A world, its body, the robot that it is, and what carries it."""

    world: type[BulletWorld]
    body: Callable[[], Body]
    robot: Robot
    mass: float
    wheels: int


def _three(drive: str) -> Kind:
    body = lambda: tricycle(package_file("urdf/tricycle.urdf"), RADIUS, TRACK, WHEELBASE, drive)  # type: ignore[arg-type]  # noqa: E731
    spec = {"drive": drive, "wheel_radius": RADIUS, "track": TRACK, "wheelbase": WHEELBASE}
    return Kind(TricycleWorld, body, Tricycle(TricycleSpec.model_validate(spec)), 24.0, 3)


KINDS = {
    "diffdrive": Kind(
        BulletWorld,
        lambda: diffdrive(package_file("urdf/diffdrive.urdf"), RADIUS, TRACK),
        DiffDrive(DiffDriveSpec(wheel_radius=RADIUS, track=TRACK)),
        9.0,
        2,
    ),
    "front": _three("front"),
    "rear": _three("rear"),
}
TRICYCLES = ("front", "rear")


class Driven:
    """A world whose steering axis, if there is one, stands at an angle and does not move."""

    def __init__(self, kind: str, steering: float = 0.0, **spec: float) -> None:
        self.kind = KINDS[kind]
        block = BulletSpec.model_validate(spec)
        self.world = self.kind.world(self.kind.body(), block, AT, BEHIND, Cost())
        drives = self.kind.robot.drives
        self.steered = "steering" in drives
        self.effects = Effects([block.friction] * self.kind.wheels, len(drives))
        self.friction = [0.0] * len(drives)
        if self.steered:
            self.friction[-1] = HELD
            self.world.turn(len(drives) - 1, steering)
        self.steering = steering

    def step(self, torque: float | list[float]) -> None:
        """Runs a tick with a torque (N m) at every driven wheel, or one at each."""
        wheels = len(self.friction) - self.steered
        torques = [torque] * wheels if isinstance(torque, float) else torque
        self.world.step([*torques, 0.0][: len(self.friction)], self.friction, self.effects)

    def go(self, torque: float, ticks: int) -> None:
        """Runs ticks, looking in each where the robot is."""
        for _ in range(ticks):
            self.step(torque)
            assert self.world.pose

    def roll(self, command: Command, ticks: int) -> tuple[float, float]:
        """Turns the wheels as a command says; returns the way (m) and the turn (rad) of the axle."""
        targets = self.kind.robot.wheel_speeds(command)
        way = turned = 0.0
        for _ in range(ticks):
            x, y, yaw = self.world.pose
            wheels = zip(targets, self.world.speeds[: len(targets) - self.steered], strict=False)
            self.step([0.4 * (target - speed) for target, speed in wheels])
            after = self.world.pose
            way += hypot(after.x - x, after.y - y)
            turned += wrap(after.yaw - yaw)
        return way, turned


Make = Callable[..., Driven]


@pytest.fixture
def make() -> Iterator[Make]:
    made: list[Driven] = []

    def build(kind: str, steering: float = 0.0, **spec: float) -> Driven:
        made.append(Driven(kind, steering, **spec))
        return made[-1]

    yield build
    for driven in made:
        driven.world.close()


@pytest.mark.parametrize("kind", KINDS)
def test_every_wheel_carries_its_part_of_the_weight(make: Make, kind: str) -> None:
    driven = make(kind)
    for _ in range(300):
        driven.step(0.0)
    forces = driven.world.normal_forces()
    assert len(forces) == len(driven.world.wheels) == driven.kind.wheels
    assert min(forces) > 0.1 * driven.kind.mass * 9.81
    castor = 0.0 if driven.steered else driven.kind.mass * 9.81 - sum(forces)
    assert sum(forces) + castor == pytest.approx(driven.kind.mass * 9.81, rel=1e-3)
    assert driven.world.pose == pytest.approx(AT, abs=1e-6)


@pytest.mark.parametrize("kind", TRICYCLES)
def test_three_wheels_carry_it_as_levers_say(make: Make, kind: str) -> None:
    """Moments about the rear axle: body at 0.38 of the wheelbase, fork and front wheel at its end."""
    driven = make(kind)
    for _ in range(300):
        driven.step(0.0)
    ahead = 9.81 * (20.0 * 0.38 + 1.6 + 0.8)
    rear = 0.5 * (24.0 * 9.81 - ahead)
    expected = [ahead, rear, rear] if kind == "front" else [rear, rear, ahead]
    assert driven.world.normal_forces() == pytest.approx(expected, rel=2e-3)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("v", [0.5, -0.4])
@pytest.mark.parametrize("curve", [0.0, 0.4, -0.7])
def test_it_rolls_as_its_wheels_turn(make: Make, kind: str, v: float, curve: float) -> None:
    """Distance and yaw within 0.05 % of what odometry's arcs make of the wheels' angles, without slip."""
    driven = make(kind, curve)
    way, turned = driven.roll(Command(v, curve), 5000)
    angles = driven.world.angles
    distance, turn = driven.kind.robot.travel([*angles[:-1], curve] if driven.steered else angles)
    assert way == pytest.approx(abs(distance), rel=5e-4)
    assert turned == pytest.approx(turn, rel=5e-4, abs=1e-5)
    assert abs(turned) > 0.5 or curve == 0.0
    assert max(map(abs, driven.world.slips)) < 1e-3


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("friction", [0.15, 0.4])
def test_it_slips_where_coulomb_says(make: Make, kind: str, friction: float) -> None:
    """τ = μ N R (1 + J_share/(m_share R²)): driven wheels push all of the robot and every wheel's spin."""
    driven = make(kind, friction=friction)
    body, wheels = driven.kind.body(), len(driven.friction) - driven.steered
    idle = driven.kind.wheels - wheels
    carried = driven.kind.mass + idle * body.spin / RADIUS**2  # wheels that are only rolled along
    share = 1.0 + wheels * (body.spin + BEHIND.wheel) / (carried * RADIUS**2)
    torque = 0.3 * friction * driven.kind.mass * 9.81 / driven.kind.wheels * RADIUS
    for _ in range(20_000):
        if max(driven.world.slips) > 2e-4:
            break
        torque += 0.5e-3
        driven.step(torque)
    loads = driven.world.normal_forces()[:wheels]
    assert torque == pytest.approx(friction * sum(loads) / wheels * RADIUS * share, rel=0.02)


@pytest.mark.parametrize("kind", KINDS)
def test_a_push_to_the_side_topples_it(make: Make, kind: str) -> None:
    """Falls over: Diverged, with when and where."""
    driven = make(kind, friction=5.0)
    driven.effects.push = (-500.0, 750.0, 0.0)  # square to its heading
    with pytest.raises(Diverged, match=r"t = 0\.\d+ s: the robot fell over at x = .* \(tilt \d+°\)"):
        driven.go(0.0, 1000)


@pytest.mark.parametrize("kind", KINDS)
def test_it_does_not_leave_the_arena(make: Make, kind: str) -> None:
    driven = make(kind, arena=1.1)
    with pytest.raises(Diverged, match=r"the robot left the arena of ±1.1 m at x = 1\.10"):
        driven.go(1.0, 3000)


@pytest.mark.parametrize("kind", KINDS)
def test_a_torque_that_is_no_number_is_divergence(make: Make, kind: str) -> None:
    driven = make(kind)
    with pytest.raises(Diverged, match="run away"):
        driven.go(float("nan"), 3)


@pytest.mark.parametrize("kind", KINDS)
def test_the_same_to_the_bit(make: Make, kind: str) -> None:
    traces = []
    for _ in range(2):
        driven, trace = make(kind, 0.3), []
        for k in range(300):
            driven.effects.friction[-1] = 0.05 if 100 < k < 200 else 0.8
            driven.step(0.5 + 0.002 * k)
            trace.append((driven.world.pose, tuple(driven.world.speeds), tuple(driven.world.slips)))
        traces.append(repr(trace))
    assert traces[0] == traces[1]


@pytest.mark.parametrize("kind", TRICYCLES)
@pytest.mark.parametrize("angle", [pi / 2, -pi / 2, 1.5])
def test_steered_to_a_right_angle_it_turns_about_its_axle_or_stands(
    make: Make, kind: str, angle: float
) -> None:
    """The front wheel drives it round the rear axle's midpoint; rear wheels push against it in vain."""
    driven = make(kind, angle)
    if kind == "front":
        driven.roll(Command(0.3, angle), 2000)
        front = driven.world.angles[0] * RADIUS
        distance, turn = driven.kind.robot.travel([driven.world.angles[0], angle])
        assert abs(turn) == pytest.approx(abs(front) / WHEELBASE, rel=3e-3)
        assert wrap(driven.world.pose.yaw - AT.yaw) == pytest.approx(turn, rel=2e-3)
        assert hypot(driven.world.pose.x - AT.x, driven.world.pose.y - AT.y) <= abs(distance) + 2e-3
        return
    for _ in range(1000):
        driven.step(0.5)
    turned = wrap(driven.world.pose.yaw - AT.yaw)
    if abs(angle) == pi / 2:
        assert driven.world.pose == pytest.approx(AT, abs=5e-3)
    else:
        assert turned > 0.0
