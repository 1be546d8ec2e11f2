"""The seams of the bench: what a part must do to take the place of another."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from hilbed.types import (
    Command,
    Estimate,
    Frame,
    Nanos,
    Odometry,
    Reading,
    Received,
    ReferencePoint,
    Snapshot,
    Transfer,
    Truth,
)


class Base(Protocol):
    """The robot as its controller sees it."""

    def read(self, t: Nanos) -> Odometry: ...

    def write(self, t: Nanos, command: Command) -> None: ...


class Bus(Protocol):
    """Carries frames: the simulated wire, any python-can bus or a replayed log."""

    def send(self, t: Nanos, frame: Frame) -> None: ...

    def recv(self, t: Nanos) -> list[Received]:
        """Returns, without waiting, what has arrived up to and including `t` since the last call."""
        ...


class Robot(Protocol):
    """Kinematics of one kind of robot."""

    @property
    def drives(self) -> tuple[str, ...]: ...

    def wheel_speeds(self, command: Command) -> tuple[float, ...]:
        """Converts a command to a target of each drive, in the order of `drives`.

        rad/s of a wheel; rad of a steering axis.
        """
        ...

    def travel(self, turned: Sequence[float]) -> tuple[float, float]:
        """Converts angles (or rates) of the wheels to distance and turn (or v and w) of the robot.

        One number a drive; that of a steering axis is its angle (rad), not its change.
        """
        ...

    def limited(self, command: Command) -> Command:
        """Returns the command within the robot's limits."""
        ...

    def twist(self, command: Command) -> tuple[float, float]:
        """Returns speed (m/s) of the axle's midpoint and yaw rate (rad/s) that a command gives."""
        ...

    def command(self, v: float, w: float) -> Command:
        """Returns the command for them, within the limits: the inverse of `twist`."""
        ...


class Plant(Protocol):
    """The far end: drives, shafts and world, on the physics clock."""

    def truth(self) -> Truth: ...

    def advance(self, start: Nanos, end: Nanos) -> None: ...


class Sensor(Protocol):
    """Samples the world when it is `due` and delivers readings after its latency."""

    @property
    def due(self) -> Nanos:
        """The next moment at which the plant must call `sample`."""
        ...

    def sample(self, truth: Truth) -> None: ...

    def read(self, t: Nanos) -> list[Reading]: ...


class Estimator(Protocol):
    def step(self, t: Nanos, odometry: Odometry, readings: Sequence[Reading]) -> Estimate: ...


class Controller(Protocol):
    def step(self, t: Nanos, estimate: Estimate) -> Command: ...


class Reference(Protocol):
    """A path with a timetable."""

    def at(self, t: Nanos) -> ReferencePoint: ...


class Witness(Protocol):
    """Where sensors report the truth behind a reading: the recorder's ear, deaf to the controller."""

    def reading(self, reading: Reading, beacon: int, true: tuple[float, ...]) -> None:
        """Notes a reading with its true beacon (−1: spurious) and true value (NaN: none)."""
        ...

    def snapshot(self, snapshot: Snapshot) -> None:
        """Notes an exposed camera frame and what was found in it."""
        ...

    def transfer(self, transfer: Transfer) -> None:
        """Notes a frame that has crossed the bus, or an error frame with what it has cut off."""
        ...
