"""The position modes of an axis, of which one at a time has the speed."""

from __future__ import annotations

from typing import Any, Protocol

from firmware_sim.cyclic_position import CyclicPosition
from firmware_sim.homing import Homing
from firmware_sim.objects.profile import CYCLIC_POSITION, HOMING, PROFILE_POSITION
from firmware_sim.place import Place
from firmware_sim.profile_position import ProfilePosition
from firmware_sim.settings import Settings


class PositionMode(Protocol):
    """What a position mode does with controlwords, settings and ticks; counts: where the axis is."""

    def heed(self, before: int, word: int, counts: int) -> None:
        """Takes the bits of a controlword that are the mode's own, in operation enabled."""
        ...

    def begin(self, counts: int) -> None:
        """Takes the speed over; the demand is where the axis is."""
        ...

    def aim(self) -> bool:
        """Something was written; returns whether 607D limits the target."""
        ...

    def step(self, counts: int) -> float:
        """Returns the speed (rad/s) for this tick."""
        ...

    def rest(self, halted: bool) -> None:
        """Leaves the speed to others: the axis is halted, or in another mode, or has no power."""
        ...


class Positioner:
    """active: whether the speed is that of `step`, which is the mode's; idle: no mode has anything to do."""

    __slots__ = ("_modes", "_now", "active", "homing", "idle", "place", "profile", "step")

    def __init__(self, values: dict[int, Any], settings: Settings) -> None:
        self.place = Place(values, settings)
        self.homing = Homing(self.place)
        self.profile = ProfilePosition(self.place)
        self._modes: dict[int, PositionMode] = {
            CYCLIC_POSITION: CyclicPosition(self.place),
            PROFILE_POSITION: self.profile,
            HOMING: self.homing,
        }
        self._now: PositionMode = self.homing
        self.step = self._now.step
        self.active, self.idle = False, True

    def aim(self, mode: int, counts: int) -> bool:
        """Goes on, or begins, to do what the mode asks for; returns whether 607D limits its target."""
        wanted = self._modes[mode]
        if self._now is not wanted:
            self.rest(halted=False)
            self._now, self.step = wanted, wanted.step
        if not self.active:
            self.active, self.idle = True, False
            self.place.loop.start(counts)
            wanted.begin(counts)
        return wanted.aim()

    def heed(self, mode: int, before: int, word: int, counts: int) -> None:
        """Hands a controlword to the mode, if it is a position mode that has begun."""
        if not self.idle and self._modes.get(mode) is self._now:
            self._now.heed(before, word, counts)

    def rest(self, halted: bool) -> None:
        """Has no mode move the axis; halted: it may go on where it was."""
        self.active, self.idle = False, not halted
        self._now.rest(halted)
