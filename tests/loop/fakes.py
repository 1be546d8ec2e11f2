"""A rig of fakes that write down who was asked what, and when."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hilbed.cost import Cost
from hilbed.loop import Rig
from hilbed.types import Command, Estimate, Nanos, Odometry, Pose, Reading, Truth

Call = tuple[str, Nanos]


class World:
    """A base, a plant and a sensor in one: a point that moves along x at the speed commanded last.

    diary: (who, t) of every call. Measures its own position, delivered `late` ns after exposure.
    """

    def __init__(self, rate: Nanos = 20, late: Nanos = 5) -> None:
        self.diary: list[Call] = []
        self.now: Nanos = 0
        self.x = self.read_x = 0.0
        self.v = 0.0
        self.due: Nanos = 0
        self.rate, self.late = rate, late
        self.sent: list[Reading] = []

    def truth(self) -> Truth:
        self.diary.append(("truth", self.now))
        return Truth(self.now, Pose(self.x, 0.0, 0.0))

    def advance(self, start: Nanos, end: Nanos) -> None:
        assert start == self.now
        self.diary.append(("advance", start))
        self.x += self.v * (end - start) * 1e-9
        self.now = end
        if self.due <= end:
            self.sent.append(Reading("position", end, end + self.late, (self.x, 0.0), (0.1, 0.1)))
            self.due = end + self.rate

    def sample(self, truth: Truth) -> None:
        raise AssertionError(f"the plant samples, not the loop ({truth})")

    def write(self, t: Nanos, command: Command) -> None:
        self.diary.append(("write", t))
        self.v = command.v

    def base(self) -> Base:
        """Returns the same world as the controller's side sees it."""
        return Base(self)

    def read(self, t: Nanos) -> list[Reading]:
        self.diary.append(("readings", t))
        arrived = [reading for reading in self.sent if reading.delivered <= t]
        self.sent = [reading for reading in self.sent if reading.delivered > t]
        return arrived


class Base:
    """Odometry of the world."""

    def __init__(self, world: World) -> None:
        self._world = world

    def read(self, t: Nanos) -> Odometry:
        world = self._world
        world.diary.append(("odometry", t))
        way, world.read_x = world.x - world.read_x, world.x
        return Odometry(t, way, 0.0, world.v, 0.0)

    def write(self, t: Nanos, command: Command) -> None:
        self._world.write(t, command)


class Adder:
    """An estimator that adds up odometry and remembers what it was given."""

    def __init__(self, world: World) -> None:
        self._world = world
        self.x = 0.0
        self.heard: list[tuple[Nanos, Reading]] = []

    def step(self, t: Nanos, odometry: Odometry, readings: Sequence[Reading]) -> Estimate:
        self._world.diary.append(("estimate", t))
        self.x += odometry.distance
        self.heard += [(t, reading) for reading in readings]
        return Estimate(t, np.array([self.x, 0.0, 0.0]), np.eye(3))


class Halfway:
    """A controller that drives towards x = 1 at a speed in proportion to the way that is left."""

    def __init__(self, world: World) -> None:
        self._world = world

    def step(self, t: Nanos, estimate: Estimate) -> Command:
        self._world.diary.append(("command", t))
        return Command(1e9 * (1.0 - float(estimate.mean[0])) / 20, 0.0)


def rig(period: Nanos = 10, world: World | None = None) -> tuple[Rig, World, Adder]:
    """Returns a rig of fakes with its world and its estimator; period in ns."""
    world = world or World()
    estimator = Adder(world)
    parts = Rig(world.base(), (world,), estimator, Halfway(world), world, period, Cost())
    return parts, world, estimator
