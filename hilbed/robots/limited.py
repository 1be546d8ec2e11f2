"""A robot whose wheels are not asked for more than a speed: what a run with real drives starts under."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

from hilbed.ports import Robot
from hilbed.robots.tricycle import STEERING
from hilbed.types import Command


class Limited:
    """Slows all wheels by one factor, so that the robot stays on its path; a steering axis is left alone."""

    def __init__(self, robot: Robot, limits: Sequence[float | None]) -> None:
        """limits: rad/s of each drive's wheel, None for no limit; that of a steering axis is not asked."""
        self._robot = robot
        self._limits = [inf if limit is None else limit for limit in limits]
        self._wheels = len([name for name in robot.drives if name != STEERING])

    @property
    def drives(self) -> tuple[str, ...]:
        return self._robot.drives

    def wheel_speeds(self, command: Command) -> tuple[float, ...]:
        targets = self._robot.wheel_speeds(command)
        speeds = targets[: self._wheels]
        fastest = max(abs(speed) / limit for speed, limit in zip(speeds, self._limits))  # noqa: B905
        if fastest <= 1.0:
            return targets
        return (*[speed / fastest for speed in speeds], *targets[self._wheels :])

    def travel(self, turned: Sequence[float]) -> tuple[float, float]:
        return self._robot.travel(turned)

    def limited(self, command: Command) -> Command:
        return self._robot.limited(command)

    def twist(self, command: Command) -> tuple[float, float]:
        return self._robot.twist(command)

    def command(self, v: float, w: float) -> Command:
        return self._robot.command(v, w)
