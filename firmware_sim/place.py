"""Where an axis is and should be, in the numbers of the bus: what all position modes work on."""

from __future__ import annotations

from typing import Any

from firmware_sim.entry import key
from firmware_sim.errors import ErrorCode
from firmware_sim.settings import Settings, read_position

_HOME = key(0x607C)


class Place:
    """position = polarity × counts + `home`; positions do not wrap: an axis with ends is meant.

    loop: in counts; homed: whether a homing has been done since power-on; event: something that the
    statusword shows has changed, trouble: what the axis has to fail for, until the owner has looked.
    """

    __slots__ = ("event", "home", "homed", "loop", "settings", "trouble", "values")

    def __init__(self, values: dict[int, Any], settings: Settings) -> None:
        self.values = values
        self.settings = settings
        self.loop = read_position(values)
        self.home = 0
        self.homed = self.event = False
        self.trouble: ErrorCode | None = None

    def configure(self, settings: Settings) -> None:
        """Takes new gains and limits over, without a bump."""
        demand = self.loop.demand
        self.settings = settings
        self.loop = read_position(self.values)
        self.loop.start(demand)

    def set_home(self, counts: int) -> None:
        """Declares the position where the axis is now to be what 607C says."""
        self.home = self.values[_HOME] - counts * self.settings.polarity
        self.homed = self.event = True

    def goal(self, target: float) -> float:
        """Returns the counts of a target within the limits of 607D."""
        low, high = self.settings.lowest, self.settings.highest
        kept = low if target < low else high if target > high else target
        return (kept - self.home) * self.settings.polarity

    def limits(self, target: float) -> bool:
        """Tells whether 607D does not let a target be."""
        return not self.settings.lowest <= target <= self.settings.highest

    def position(self, counts: float) -> float:
        """Returns the position at these counts."""
        return counts * self.settings.polarity + self.home

    def follow(self, moved: float, counts: int) -> float:
        """Moves the demand and returns the speed (rad/s) that follows it; an axis that lags is in trouble."""
        speed = self.loop.step(moved, counts)
        if self.lagging:
            self.fail(ErrorCode.FOLLOWING)
        return speed

    def fail(self, code: ErrorCode) -> None:
        """Has the owner see that the axis cannot go on."""
        self.trouble = code
        self.event = True

    @property
    def lagging(self) -> bool:
        """Whether the position is farther from its demand than 6065 allows."""
        return abs(self.loop.error) > self.settings.following
