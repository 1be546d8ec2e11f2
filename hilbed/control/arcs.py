"""Plane curves made of arcs of constant curvature, by length, in closed form."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Sequence
from itertools import accumulate
from math import ceil, cos, floor, pi, sin
from typing import NamedTuple

from hilbed.angles import wrap
from hilbed.types import Pose

STRAIGHT = 1e-9  # 1/m: below it an arc is a line to rounding


class Arc(NamedTuple):
    """A piece of a path: length (m, positive) and curvature (1/m, positive to the left)."""

    length: float
    curvature: float = 0.0


class Box(NamedTuple):
    """The smallest upright rectangle (m) round a path."""

    x_min: float
    y_min: float
    x_max: float
    y_max: float


def along(start: Pose, arc: Arc, length: float) -> Pose:
    """Returns the pose `length` (m) after `start` on the arc.

    x = x₀ + (sin(ψ₀ + κs) − sin ψ₀)/κ, y = y₀ − (cos(ψ₀ + κs) − cos ψ₀)/κ; a line where κ = 0.
    """
    x, y, yaw = start
    k = arc.curvature
    if abs(k) < STRAIGHT:
        return Pose(x + length * cos(yaw), y + length * sin(yaw), wrap(yaw))
    end = yaw + k * length
    return Pose(x + (sin(end) - sin(yaw)) / k, y - (cos(end) - cos(yaw)) / k, wrap(end))


class Path:
    """Arcs one after the other from a start pose; a closed path goes on for ever."""

    def __init__(self, start: Pose, arcs: Iterable[Arc], closed: bool) -> None:
        self.arcs: Sequence[Arc] = tuple(arcs)
        self.closed = closed
        self._ends = list(accumulate(arc.length for arc in self.arcs))
        self.length = self._ends[-1]
        self._starts = [start]
        for arc in self.arcs:
            self._starts.append(along(self._starts[-1], arc, arc.length))

    def at(self, length: float) -> tuple[Pose, float]:
        """Returns pose and curvature (1/m) at `length` (m) from the start; at a joint, those of the next arc.

        An open path is held at its end.
        """
        if self.closed:
            length %= self.length
        elif length >= self.length:
            return self._starts[-1], 0.0
        index = bisect_right(self._ends, length)
        if index == len(self.arcs):  # length % self.length may round to self.length
            return self._starts[0], self.arcs[0].curvature
        arc = self.arcs[index]
        return along(self._starts[index], arc, length - self._ends[index] + arc.length), arc.curvature

    def extent(self) -> Box:
        """Returns the box round the whole path."""
        points = [
            p for start, arc in zip(self._starts, self.arcs, strict=False) for p in _corners(start, arc)
        ]
        xs, ys = zip(*points, strict=True)
        return Box(min(xs), min(ys), max(xs), max(ys))


def _corners(start: Pose, arc: Arc) -> list[tuple[float, float]]:
    """Returns both ends of an arc and the points where it runs along an axis."""
    lengths = [0.0, arc.length]
    if abs(arc.curvature) >= STRAIGHT:
        sweep = arc.length * arc.curvature
        low, high = sorted((start.yaw, start.yaw + sweep))
        quarters = range(ceil(low / (pi / 2)), min(floor(high / (pi / 2)), ceil(low / (pi / 2)) + 3) + 1)
        lengths += [(q * pi / 2 - start.yaw) / arc.curvature for q in quarters]
    return [along(start, arc, s)[:2] for s in lengths]
