"""Where something is that goes along a path, at any time."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import atan2, hypot
from typing import NamedTuple

from hilbed.clock import SECOND
from hilbed.types import Nanos

Point = tuple[float, float]


class Walk(NamedTuple):
    """From the first of the points (m, two or more, none twice in a row) on at `speed` (m/s).

    Around and around if closed, else to the last point and back.
    """

    points: Sequence[Point]
    speed: float
    closed: bool = False

    def at(self, t: Nanos) -> tuple[float, float, float]:
        """Returns x, y (m) and the heading (rad) at t."""
        back = () if self.closed else tuple(self.points[-2:0:-1])
        loop = (*self.points, *back, self.points[0])
        legs = [(a, b, hypot(b[0] - a[0], b[1] - a[1])) for a, b in pairwise(loop)]
        left = self.speed * t / SECOND % sum(length for *_, length in legs)
        for (ax, ay), (bx, by), length in legs:
            if left <= length and length > 0.0:
                part = left / length
                return ax + part * (bx - ax), ay + part * (by - ay), atan2(by - ay, bx - ax)
            left -= length
        return (*loop[-1], 0.0)  # left by rounding alone
