"""A robot whose wheels are not asked for more than a speed: what a run with real drives starts under."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

from hilbed.ports import Robot
from hilbed.types import Command


class Limited:
    """Slows all wheels by one factor, so that the robot stays on its path."""

    def __init__(self, robot: Robot, limits: Sequence[float | None]) -> None:
        """limits: rad/s of each drive's wheel, None for no limit."""
        self._robot = robot
        self._limits = [inf if limit is None else limit for limit in limits]

    @property
    def drives(self) -> tuple[str, ...]:
        return self._robot.drives

    def wheel_speeds(self, command: Command) -> tuple[float, ...]:
        speeds = self._robot.wheel_speeds(command)
        fastest = max(abs(speed) / limit for speed, limit in zip(speeds, self._limits, strict=True))
        return speeds if fastest <= 1.0 else tuple(speed / fastest for speed in speeds)

    def travel(self, turned: Sequence[float]) -> tuple[float, float]:
        return self._robot.travel(turned)
