"""What an axis does in a position mode: limits its target, follows it, and knows where home is."""

from __future__ import annotations

from typing import Any

from firmware_sim.entry import key
from firmware_sim.settings import Settings, read_position

_TARGET, _HOME = key(0x607A), key(0x607C)


class Positioner:
    """The position loop in the numbers of the bus: position = polarity × counts + `home`.

    active: whether the speed is the loop's; homed: whether a homing has been done since power-on; lost: the
    axis is farther behind its demand than 6065 allows. Positions do not wrap: an axis with ends is meant.
    """

    __slots__ = ("_following", "_loop", "active", "home", "homed")

    def __init__(self, values: dict[int, Any]) -> None:
        self.active = self.homed = False
        self.home = 0
        self._following = 0.0
        self._loop = read_position(values)

    def configure(self, values: dict[int, Any], settings: Settings) -> None:
        """Takes new gains and limits over, without a bump."""
        demand = self._loop.demand
        self._loop = read_position(values)
        self._loop.start(demand)
        self._following = settings.following

    def set_home(self, values: dict[int, Any], settings: Settings, counts: int) -> None:
        """Declares the position where the axis is now to be what 607C says."""
        self.home = values[_HOME] - counts * settings.polarity
        self.homed = True
        self._loop.start(counts)

    def aim(self, values: dict[int, Any], settings: Settings, counts: int) -> bool:
        """Goes on, or begins, to follow the target; returns whether 607D limits it."""
        if not self.active:
            self._loop.start(counts)
            self.active = True
        target, low, high = values[_TARGET], settings.lowest, settings.highest
        goal = low if target < low else high if target > high else target
        self._loop.aim((goal - self.home) * settings.polarity, settings.interpolation)
        return bool(goal != target)

    def step(self, counts: int) -> float:
        """Returns the speed (rad/s) for this tick."""
        return self._loop.step(counts)

    @property
    def lost(self) -> bool:
        return abs(self._loop.error) > self._following

    def shown(self, settings: Settings) -> tuple[float, float]:
        """Returns position demand (6062) and following error (60F4)."""
        polarity, loop = settings.polarity, self._loop
        return loop.demand * polarity + self.home, loop.error * polarity
