"""The point of a cloud with the most neighbours, found exactly without looking at every pair."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite
from typing import NamedTuple

import numpy as np

from hilbed.control.support_grid import Grid, Ints, blocks, closer_than_one
from hilbed.types import Array

PROBED = 2**13  # so many pairs are tested to raise the bar before points are dropped
CELLS = 64  # a grid may have so many a point
LOOKUPS = 2**16  # so many, and the first grid is fine enough
PAIRS = 2**16  # so few are tested without a grid
SOME, MOST = 128, 2**20  # points that are counted at once at the end, and the pairs that these may have
COARSEST, FIRST, FINEST = 8.0, 32.0, 1024.0  # cells a unit: of the first grid if they fit, at most; of any


class Leader(NamedTuple):
    """The best point so far (its index) and how many are less than 1 away from it."""

    support: int
    point: int


def most_supported(x: Array, y: Array) -> int:
    """Returns the index of the point with the most points less than 1 away, itself included.

    x, y: (M,), a command over the radii of the ellipse of support. Ties go to the lowest index. Bounds from
    ever finer grids drop what cannot win; what is left is counted pair by pair, only where cells leave a
    doubt. Lages & Alves (2017), S_i. Raises ValueError where there is no point or the extent is not finite.
    """
    if not len(x):
        raise ValueError("support needs at least one point")
    width, height = float(np.ptp(x)), float(np.ptp(y))
    if not isfinite(width + height):
        raise ValueError(f"support needs finite points, these extend over {width:g} by {height:g}")
    if width * width + height * height < 1:  # every point supports every other
        return 0
    left, leader = np.arange(len(x)), Leader(0, 0)
    for n in _sides(len(x), width, height):
        grid = Grid(x, y, n)
        bound = grid.at_most(left)
        probes = left[np.flatnonzero(bound == bound.max())[: max(PROBED // len(x), 1)]]
        leader = _better(leader, probes, _counted(x, y, probes))
        left, bound = _contenders(leader, left, bound)
        if len(left) * len(x) <= PAIRS:
            return _better(leader, left, _counted(x, y, left)).point
    return _finish(grid, left, bound, leader).point


def _sides(count: int, width: float, height: float) -> Iterator[float]:
    """Yields how many cells a unit has, for ever finer grids that are worth their memory; at least once."""
    n = COARSEST
    while (
        n < FIRST and _fits(2 * n, width, height, count) and count * (4 * n * min(height, 1) + 1) <= LOOKUPS
    ):
        n *= 2
    while not _fits(n, width, height, count):
        n /= 2
    yield n
    while finer := [m for m in (4 * n, 2 * n) if m <= FINEST and _fits(m, width, height, count)]:
        n = finer[0]
        yield n


def _fits(n: float, width: float, height: float, count: int) -> bool:
    """Tells whether the cells, with the border that a reach of one unit needs, are not too many."""
    columns, rows = width * n, height * n
    return (columns + 2 * min(columns, n) + 9) * (rows + 2 * min(rows, n) + 9) <= CELLS * (count + 64)


def _contenders(leader: Leader, points: Ints, bound: Ints) -> tuple[Ints, Ints]:
    """Returns the points that may still be better than the leader, with their bounds."""
    keep = (bound > leader.support) | ((bound == leader.support) & (points < leader.point))
    return points[keep], bound[keep]


def _better(leader: Leader, points: Ints, counts: Ints) -> Leader:
    """Returns the leader or the best of these points (ascending), whichever is better."""
    if not len(points):
        return leader
    k = int(counts.argmax())
    rival = Leader(int(counts[k]), int(points[k]))
    return rival if (rival.support, -rival.point) > (leader.support, -leader.point) else leader


def _counted(x: Array, y: Array, points: Ints) -> Ints:
    """Returns the support of a few points by looking at all."""
    counts = np.zeros(len(points), dtype=np.intp)
    for some in blocks(np.arange(len(points)), len(x)):
        chosen = points[some, None]
        counts[some] = np.count_nonzero(closer_than_one(x[chosen] - x, y[chosen] - y), axis=1)
    return counts


def _finish(grid: Grid, left: Ints, bound: Ints, leader: Leader) -> Leader:
    """Counts the points left, the most promising first, as long as they may be better than the leader."""
    doubt = int((bound - grid.at_least(left)).max(initial=1))
    size = max(min(SOME, MOST // doubt), 1)
    while len(left):
        best = np.argpartition(-bound, size - 1)[:size] if len(left) > size else np.arange(len(left))
        some = np.sort(best)
        leader = _better(leader, left[some], grid.exactly(left[some]))
        left, bound = _contenders(leader, np.delete(left, some), np.delete(bound, some))
    return leader
