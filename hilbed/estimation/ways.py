"""Odometry that can be cut at the moment of an exposure, and readings that wait for odometry."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from hilbed.types import Nanos, Reading


class Way(NamedTuple):
    """An odometry increment: from, to, distance (m), turn (rad)."""

    start: Nanos
    end: Nanos
    distance: float
    turn: float

    def cut(self, t: Nanos) -> tuple[Way, Way]:
        """Returns the parts before and after a moment in between."""
        share = (t - self.start) / (self.end - self.start)
        before = Way(self.start, t, share * self.distance, share * self.turn)
        return before, Way(t, self.end, self.distance - before.distance, self.turn - before.turn)


def split(ways: list[Way], t: Nanos) -> tuple[list[Way], list[Way]]:
    """Returns what of the ways is before and what is after a moment."""
    before = [way for way in ways if way.end <= t]
    after = ways[len(before) :]
    if after and after[0].start < t:
        first, rest = after[0].cut(t)
        return [*before, first], [rest, *after[1:]]
    return before, after


class Waiting:
    """Readings in the order of their exposure, held back until odometry has come that far."""

    def __init__(self, memory: Nanos) -> None:
        """memory: how far ahead of odometry an exposure may be."""
        self._memory = memory
        self._held: list[Reading] = []

    def due(self, readings: Sequence[Reading], t: Nanos) -> tuple[list[Reading], int]:
        """Takes new readings; returns those exposed by `t`, and how many were refused as too far ahead."""
        believable = [reading for reading in readings if reading.t <= t + self._memory]
        held = sorted(self._held + believable, key=_order)
        self._held = [reading for reading in held if reading.t > t]
        return held[: len(held) - len(self._held)], len(readings) - len(believable)


def _order(reading: Reading) -> tuple[Nanos, bool, int]:
    """Named ones first and by name, so that the order of arrival is nothing."""
    return reading.t, reading.beacon is None, reading.beacon or 0
