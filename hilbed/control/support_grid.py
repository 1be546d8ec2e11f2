"""A fine grid over points that bounds, for each, how many lie less than 1 away, and counts the doubtful."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property, lru_cache
from math import isqrt
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from hilbed.types import Array

Ints: TypeAlias = npt.NDArray[np.intp]

TABLE = 2**13  # entries of what is looked up at once: in the cache, and memory that malloc keeps


class Reach(NamedTuple):
    """Cells round a cell, row by row: half-open runs of columns relative to it, one entry a row.

    out: nothing outside [-out, out] can be near; all in [inner_start, inner_end) is near.
    """

    row: Ints
    out: Ints
    inner_start: Ints
    inner_end: Ints


@lru_cache(maxsize=64)
def reach(n: int, rows: int, columns: int) -> Reach:
    """Returns the cells near a cell, for cells of side 1/n and points at most rows, columns apart, n or less.

    Points of two cells that are i columns and j rows apart are at least (max(i − 1, 0), max(j − 1, 0))/n
    and less than (i + 1, j + 1)/n apart.
    """
    row = np.arange(-rows, rows + 1)
    nearest = [n * n - max(abs(j) - 1, 0) ** 2 for j in row.tolist()]
    farthest = [n * n - (abs(j) + 1) ** 2 for j in row.tolist()]
    out = np.array([min(isqrt(q - 1) + 1, columns) for q in nearest])
    inner = np.array([min(isqrt(q - 1), columns + 1) if q > 0 else 0 for q in farthest])
    return Reach(row, out, np.minimum(1 - inner, 0), inner)


class Grid:
    """Points in square cells of side 1/n, n a power of two, so that a point's cell is exact to the bit.

    So are the bounds, since differences, squares and sums of floats keep the order of what they stand for.
    For n below 1 cells are larger than 1, and only those that touch are near.
    """

    def __init__(self, x: Array, y: Array, n: float) -> None:
        """x, y: (M,), finite, at least one; their extents times n are what memory must hold."""
        self._x, self._y = x, y
        column, row = _lines(x, n), _lines(y, n)
        N = max(int(n), 1)
        near = reach(N, min(int(row.max()), N), min(int(column.max()), N))
        aside, above = int(near.out.max()), int(near.row[-1])
        width = int(column.max()) + 1 + 2 * aside
        self._size = (int(row.max()) + 1 + 2 * above) * width
        self._cell = (row + above) * width + column + aside
        self._before = np.zeros(self._size + 1, dtype=np.intp)
        np.cumsum(np.bincount(self._cell, minlength=self._size), out=self._before[1:])
        shift = near.row * width
        self._edges = [
            (shift + edge)[:, None] for edge in (-near.out, near.inner_start, near.inner_end, near.out + 1)
        ]

    def at_most(self, points: Ints) -> Ints:
        """Returns for each of these points (K,) a number that its neighbours, with itself, do not exceed."""
        return self._between(self._edges[0], self._edges[3], points)

    def at_least(self, points: Ints) -> Ints:
        """Returns for each of these points (K,) a number that its neighbours, with itself, reach."""
        return self._between(self._edges[1], self._edges[2], points)

    def _between(self, start: Ints, end: Ints, points: Ints) -> Ints:
        """Returns how many points are in the runs of cells round each point's cell, once for each cell."""
        cell = self._cell[points]
        occupied = np.flatnonzero(np.bincount(cell, minlength=self._size))
        sums = np.zeros(self._size, dtype=np.intp)
        for some in blocks(occupied, len(start)):
            sums[some] = (self._before[end + some] - self._before[start + some]).sum(axis=0)
        of_points: Ints = sums[cell]
        return of_points

    def exactly(self, points: Ints) -> Ints:
        """Returns for each of these points (K,) how many are less than 1 away, itself among them."""
        edges = (self._before[edge + self._cell[points]] for edge in self._edges)
        start, inner_start, inner_end, end = edges
        first = np.concatenate((start, inner_end)).T.ravel()
        length = np.concatenate((inner_start - start, end - inner_end)).T
        owner = np.repeat(np.arange(len(points)), length.sum(axis=1))
        doubtful = _ranges(first, length.ravel())
        x, y = self._by_cell
        near = closer_than_one(self._x[points][owner] - x[doubtful], self._y[points][owner] - y[doubtful])
        sure: Ints = (inner_end - inner_start).sum(axis=0)
        sure += np.bincount(owner[near], minlength=len(points))
        return sure

    @cached_property
    def _by_cell(self) -> tuple[Array, Array]:
        """Coordinates in the order of the cells, in which a run of cells is a slice."""
        order = np.argsort(self._cell)
        return self._x[order], self._y[order]


def closer_than_one(dx: Array, dy: Array) -> npt.NDArray[np.bool_]:
    """Tells where points at these differences are strictly inside the unit circle: the exact test."""
    return dx * dx + dy * dy < 1


def _lines(values: Array, n: float) -> Ints:
    """Returns the row or column of each coordinate, from 0."""
    line = np.floor(values * n)
    from_zero: Ints = (line - line.min()).astype(np.intp)
    return from_zero


def _ranges(first: Ints, length: Ints) -> Ints:
    """Returns the numbers first, first + 1, … of every range, one range after the other."""
    ends: Ints = np.cumsum(length)
    numbers: Ints = np.arange(ends[-1]) + np.repeat(first - (ends - length), length)
    return numbers


def blocks(items: Ints, rows: int) -> Iterator[Ints]:
    """Cuts items into blocks that, with so many rows each, are small tables."""
    size = max(TABLE // rows, 1)
    return (items[k : k + size] for k in range(0, len(items), size))
