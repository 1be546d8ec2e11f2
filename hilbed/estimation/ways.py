"""Odometry increments that can be cut at the moment of an exposure."""

from __future__ import annotations

from typing import NamedTuple

from hilbed.types import Nanos


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
