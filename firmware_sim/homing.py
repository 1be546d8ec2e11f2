"""Homing (CiA 402): where the axis stands, or by a switch: towards it fast, back over its edge slowly.

An axis that begins beyond the edge goes back fast first, so that a slow way is never a long one.
"""

from __future__ import annotations

from types import MappingProxyType
from typing import Final, NamedTuple

from firmware_sim.entry import key
from firmware_sim.errors import ErrorCode
from firmware_sim.place import Place

NEGATIVE_LIMIT, POSITIVE_LIMIT, HOME = 1, 2, 4
"""Bits of the digital inputs (60FD)."""
START: Final = 0x0010
"""Of the controlword: home; lowered before the end it interrupts."""
_INPUTS, _METHOD, _PATIENCE = key(0x60FD), key(0x6098), key(0x2015)
_FAST, _SLOW = key(0x6099, 1), key(0x6099, 2)


_AWAY, _TOWARDS, _SLOWLY = range(3)  # the legs of a search


class Method(NamedTuple):
    """A switch, the direction (of the position) in which it is sought, and the state that ends the search.

    Then the edge counts that is passed slowly on the way back.
    """

    input: int
    direction: int
    until: bool


METHODS: Final = MappingProxyType(
    {
        17: Method(NEGATIVE_LIMIT, -1, until=True),
        18: Method(POSITIVE_LIMIT, 1, until=True),
        19: Method(HOME, 1, until=True),
        20: Method(HOME, -1, until=False),
        21: Method(HOME, -1, until=True),
        22: Method(HOME, 1, until=False),
    }
)


class Homing:
    """A search, or none: a method without a switch takes the place where the axis stands.

    searching: whether the axis is on its way; failed: whether the last search found nothing in time."""

    __slots__ = ("_leg", "_method", "_place", "_ticks", "failed")

    def __init__(self, place: Place) -> None:
        self._place = place
        self._method: Method | None = None
        self.failed = False
        self._leg = _AWAY
        self._ticks = 0

    @property
    def searching(self) -> bool:
        return self._method is not None

    def heed(self, before: int, word: int, counts: int) -> None:
        """Begins as the bit rises, ends where it falls."""
        if word & ~before & START:
            self._start(counts)
        elif self.searching and not word & START:
            self._end()

    def begin(self, counts: int) -> None:
        """Stands until it is told to begin."""

    def aim(self) -> bool:
        """Has no target."""
        return False

    def step(self, counts: int) -> float:
        """Returns the speed that is wanted; the axis ramps it by 609A."""
        place, method = self._place, self._method
        if method is None:
            return 0.0
        there = bool(place.values[_INPUTS] & method.input) is method.until
        if self._leg is _AWAY and not there:
            self._leg = _TOWARDS
        elif self._leg is _TOWARDS and there:
            self._leg = _SLOWLY
        elif self._leg is _SLOWLY and not there:
            place.set_home(counts)
            self._end()
            return 0.0
        self._ticks += 1
        if 0 < place.values[_PATIENCE] <= self._ticks:
            self._give_up()
        return self._speed(method.direction)

    def rest(self, halted: bool) -> None:  # noqa: ARG002
        """An axis that is stopped does not go on by itself."""
        self._method = None

    def _start(self, counts: int) -> None:
        place = self._place
        place.homed = self.failed = False
        place.event = True
        self._leg = _AWAY
        self._ticks = 0
        self._method = METHODS.get(place.values[_METHOD])
        if self._method is None:
            place.set_home(counts)

    def _speed(self, towards: int) -> float:
        """Returns the speed of this leg of the search, rad/s in the encoder's direction."""
        settings = self._place.settings
        speed: float = self._place.values[_SLOW if self._leg is _SLOWLY else _FAST] * abs(settings.unit)
        direction = towards if self._leg is _TOWARDS else -towards
        return direction * settings.polarity * min(speed, settings.max_speed)

    def _end(self) -> None:
        self._method = None
        self._place.event = True

    def _give_up(self) -> None:
        self.failed = True
        self._end()
        self._place.fail(ErrorCode.HOMING)
