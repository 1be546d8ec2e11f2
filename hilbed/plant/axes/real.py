"""A drive and a motor that are real and elsewhere: the simulated wheel goes as fast as the drive says."""

from __future__ import annotations

from math import isfinite, nan
from typing import Protocol

from hilbed.types import Nanos

CATCHING_UP = 50.0
"""1/s; so fast a steering axis here makes up for what it is away from the reported angle."""


class Reported(Protocol):
    """What the drive last said over the bus: rad/s, rad, A in the wheel's direction, NaN before it spoke."""

    speed: float
    angle: float
    current: float
    speed_ref: float


class RealAxis:
    """A wheel that follows: its joint is held to the reported speed by no more than a torque.

    Slip, load and the other wheel act on it as on any wheel; the drive on its desk does not feel them.
    duty, torque and supply current are the drive's own affair: duty is NaN, the others are zero here.
    """

    __slots__ = (
        "_reported", "coulomb", "current", "duty", "name", "speed_ref", "supply_current", "target",
    )  # fmt: skip

    def __init__(self, name: str, reported: Reported, torque: float) -> None:
        """torque: N m, the most that holds the wheel to its speed."""
        self.name = name
        self._reported = reported
        self.coulomb = torque
        self.target: float | None = 0.0
        self.current = self.speed_ref = 0.0
        self.duty = nan
        self.supply_current = 0.0

    def present(self, angle: float, supply: int) -> None:
        """Reads pins of its own."""

    def idle(self, t: Nanos, angle: float, supply: int) -> None:
        """Needs no ticks."""

    def power(self, t: Nanos, on: bool) -> None:
        """Has a supply elsewhere, which no disturbance reaches."""

    def step(self, t: Nanos, angle: float, speed: float, volts: float, supply: int) -> float:  # noqa: ARG002
        reported = self._reported
        self.target = reported.speed if isfinite(reported.speed) else 0.0
        self.current = reported.current
        self.speed_ref = reported.speed_ref
        return 0.0


class RealSteeringAxis(RealAxis):
    """An axis that follows the angle that its drive reports: a speed alone would let the two drift apart."""

    __slots__ = ()

    def step(self, t: Nanos, angle: float, speed: float, volts: float, supply: int) -> float:
        torque = super().step(t, angle, speed, volts, supply)
        behind = self._reported.angle - angle
        if self.target is not None and isfinite(behind):
            self.target += CATCHING_UP * behind
        return torque
