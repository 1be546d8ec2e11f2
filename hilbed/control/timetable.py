"""When a path is driven: at one speed, with a ramp at the start and, on an open path, at the end."""

from __future__ import annotations

from math import inf, sqrt
from typing import NamedTuple


class Progress(NamedTuple):
    """Way from the start (m) and speed (m/s)."""

    length: float
    speed: float


class Timetable:
    """Trapezoidal speed over time; without an acceleration the speed jumps.

    speed (m/s) is lowered where the path (m, inf where closed) is too short for both ramps.
    """

    __slots__ = ("_braking", "_cruised", "_end", "_length", "_ramp", "_rate", "_speed")

    def __init__(self, speed: float, acceleration: float | None, length: float = inf) -> None:
        self._rate = acceleration or inf
        self._speed = min(speed, sqrt(self._rate * length))
        self._ramp = self._speed / self._rate
        self._length = length
        self._braking = self._ramp + (length - self._speed * self._ramp) / self._speed
        self._end = self._braking + self._ramp
        self._cruised = -self._speed * self._ramp / 2

    @property
    def duration(self) -> float:
        """Seconds to the end of the path (inf where closed)."""
        return self._end

    def at(self, seconds: float) -> Progress:
        """Returns where the reference is at a time (s ≥ 0), right-continuous."""
        if seconds < self._ramp:
            return Progress(self._rate * seconds * seconds / 2, self._rate * seconds)
        if seconds < self._braking:
            return Progress(self._cruised + self._speed * seconds, self._speed)
        left = self._end - seconds
        if left <= 0:
            return Progress(self._length, 0.0)
        return Progress(self._length - self._rate * left * left / 2, self._rate * left)
