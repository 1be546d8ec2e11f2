"""Cyclic synchronous position mode: a target with every SYNC, and a straight line from one to the next."""

from __future__ import annotations

from firmware_sim.course import Straight
from firmware_sim.entry import key
from firmware_sim.place import Place

_TARGET = key(0x607A)


class CyclicPosition:
    __slots__ = ("_course", "_place")

    def __init__(self, place: Place) -> None:
        self._place = place
        self._course = Straight()

    def heed(self, before: int, word: int, counts: int) -> None:
        """Has no bits of its own."""

    def begin(self, counts: int) -> None:
        """Sets out from here."""

    def aim(self) -> bool:
        place = self._place
        target, loop = place.values[_TARGET], place.loop
        self._course.aim(place.goal(target), loop.demand, place.settings.interpolation, loop.fastest)
        return place.limits(target)

    def step(self, counts: int) -> float:
        place = self._place
        return place.follow(self._course.step(place.loop.demand), counts)

    def rest(self, halted: bool) -> None:
        """Begins anew where the axis is then."""
