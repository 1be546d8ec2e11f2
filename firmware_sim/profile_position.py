"""Profile position mode (CiA 402): set-points are taken by a handshake, one after the other or at once."""

from __future__ import annotations

from typing import Final, NamedTuple

from firmware_sim.course import Trapezoid
from firmware_sim.entry import key
from firmware_sim.error_rate import TICK
from firmware_sim.place import Place

NEW: Final = 0x0010
"""Of the controlword: a set-point is there, as the bit rises."""
AT_ONCE: Final = 0x0020
RELATIVE: Final = 0x0040
_NO_WINDOW: Final = 0xFFFFFFFF
_TARGET, _WINDOW, _DWELL = key(0x607A), key(0x6067), key(0x6068)
_VELOCITY, _RISE, _FALL = key(0x6081), key(0x6083), key(0x6084)
_ARRIVED: Final = 1e-6  # counts: what rounding leaves between demand and goal


class SetPoint(NamedTuple):
    """goal: counts in the encoder's direction; most: counts a tick; rise, fall: counts a tick²."""

    goal: float
    most: float
    rise: float
    fall: float


class ProfilePosition:
    """acknowledged: no other set-point is taken until the master lowers its bit and there is room; reached:
    the axis has been at its goal (within 6067) for as long as 6068 says.
    """

    __slots__ = (
        "_course", "_dwelt", "_limited", "_next", "_now", "_place", "_raised", "acknowledged", "reached",
    )  # fmt: skip

    def __init__(self, place: Place) -> None:
        self._place = place
        self._course = Trapezoid()
        self._now: SetPoint | None = None
        self._next: SetPoint | None = None
        self._raised = self._limited = self.acknowledged = False
        self._dwelt = 0
        self.reached = True

    def heed(self, before: int, word: int, counts: int) -> None:  # noqa: ARG002
        """Takes a set-point as its bit rises; without room for it nothing happens."""
        if not (before ^ word) & NEW:
            return
        self._raised = bool(word & NEW)
        if self._raised:
            new = self._offered(word)
            if word & AT_ONCE or self.reached:
                self._next = None
                self._set_out(new)
            elif self._next is None:
                self._next = new
        self._acknowledge()

    def begin(self, counts: int) -> None:
        """Sets out from standstill: to the goal that was on when the axis was halted, else nowhere."""
        self._course.rest(counts)
        if self._now is not None:
            self._course.goal = self._now.goal

    def aim(self) -> bool:
        """Goes on: what is written does not count before it is offered."""
        if self._now is not None:
            self._course.most = min(self._now.most, self._place.loop.fastest)
        return self._limited

    def step(self, counts: int) -> float:
        place = self._place
        speed = place.follow(self._course.step(place.loop.demand), counts)
        if not self.reached:
            self._watch(counts)
        return speed

    def rest(self, halted: bool) -> None:
        """Halted it keeps its set-points; else they are dropped."""
        if not halted:
            self._now = self._next = None
            self._raised = self._limited = self.acknowledged = False
            self.reached = True

    def _offered(self, word: int) -> SetPoint:
        place = self._place
        values, target = place.values, place.values[_TARGET]
        if word & RELATIVE:
            target += place.position(self._course.goal if self._next is None else self._next.goal)
        self._limited = place.limits(target)
        return SetPoint(
            place.goal(target),
            values[_VELOCITY] * TICK,
            values[_RISE] * TICK * TICK,
            values[_FALL] * TICK * TICK,
        )

    def _set_out(self, new: SetPoint) -> None:
        self._now = new
        self._course.goal, _, self._course.rise, self._course.fall = new
        self._dwelt = 0
        self.reached = False
        self._place.event = True
        self.aim()

    def _watch(self, counts: int) -> None:
        """Finds out whether the axis has reached its goal, and goes on to the next one."""
        place, goal = self._place, self._course.goal
        window = place.values[_WINDOW]
        there = abs(goal - place.loop.demand) < _ARRIVED
        if not there or (window != _NO_WINDOW and abs(goal - counts) > window):
            self._dwelt = 0
            return
        self._dwelt += 1
        if self._dwelt < place.values[_DWELL]:
            return
        self.reached = place.event = True
        if self._next is not None:
            following, self._next = self._next, None
            self._set_out(following)
            self._acknowledge()

    def _acknowledge(self) -> None:
        acknowledged = self._raised or self._next is not None
        if acknowledged != self.acknowledged:
            self.acknowledged = acknowledged
            self._place.event = True
