"""OpenCV's lens distortion and its inverse, on coordinates in units of the focal length.

x is right and y down, as in cv2.projectPoints: radial k1, k2, k3 and tangential p1, p2.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np

from hilbed.types import Array

_LAST = 1e-6  # of a step: what is left is its square
_MOST_STEPS = 30


class Coefficients(NamedTuple):
    """In OpenCV's order."""

    k1: float = 0.0
    k2: float = 0.0
    p1: float = 0.0
    p2: float = 0.0
    k3: float = 0.0


def distort(x: Array, y: Array, by: Coefficients) -> tuple[Array, Array]:
    """Returns where the lens puts the points x, y of the pinhole's image."""
    return expanded(x, y, by)[:2]


def slopes(x: Array, y: Array, by: Coefficients) -> tuple[Array, Array, Array]:
    """Returns ∂x'/∂x, ∂y'/∂y and ∂x'/∂y = ∂y'/∂x of `distort`."""
    return expanded(x, y, by)[2:]


def expanded(x: Array, y: Array, by: Coefficients) -> tuple[Array, Array, Array, Array, Array]:
    """Returns what `distort` and `slopes` do."""
    x2, y2, xy = x * x, y * y, x * y
    r2 = x2 + y2
    radial = 1.0 + r2 * (by.k1 + r2 * (by.k2 + r2 * by.k3))
    bend = 2.0 * by.k1 + r2 * (4.0 * by.k2 + 6.0 * by.k3 * r2)
    p1x, p1y, p2x, p2y = 2.0 * by.p1 * x, 2.0 * by.p1 * y, 2.0 * by.p2 * x, 2.0 * by.p2 * y
    return (
        x * radial + p1x * y + by.p2 * (r2 + 2.0 * x2),
        y * radial + by.p1 * (r2 + 2.0 * y2) + p2x * y,
        radial + bend * x2 + p1y + 3.0 * p2x,
        radial + bend * y2 + 3.0 * p1y + p2x,
        bend * xy + p1x + p2y,
    )


def undistort(
    x: Array, y: Array, by: Coefficients, start: tuple[Array, Array] | None = None
) -> tuple[Array, Array]:
    """Returns the points that `distort` puts at x, y, by Newton's method from `start` (else from x, y).

    What does not converge is NaN.
    """
    u, v = (x, y) if start is None else start
    with np.errstate(all="ignore"):
        for _ in range(_MOST_STEPS):
            at_x, at_y, xx, yy, xy = expanded(u, v, by)
            off_x, off_y, det = at_x - x, at_y - y, xx * yy - xy * xy
            by_u, by_v = (yy * off_x - xy * off_y) / det, (xx * off_y - xy * off_x) / det
            u, v = u - by_u, v - by_v
            if max(np.abs(by_u).max(initial=0.0), np.abs(by_v).max(initial=0.0)) < _LAST:
                return u, v
        lost = ~(np.hypot(*np.subtract(distort(u, v, by), (x, y))) < 1e-9)
    return np.where(lost, np.nan, u), np.where(lost, np.nan, v)


def folds_at(x: Array, y: Array, by: Coefficients, steps: int = 64) -> int | None:
    """Returns the index of a point x, y of the image that the lens does not show just once, else None.

    Follows each ray from the middle of the image outwards: the image folds where the determinant of the
    slopes is not positive any more, and ends where no point of the pinhole's image leads any farther.
    """
    u, v = np.zeros_like(x), np.zeros_like(y)
    for step in range(1, steps + 1):
        part = step / steps
        u, v = undistort(part * x, part * y, by, (u, v))
        xx, yy, xy = slopes(u, v, by)
        folded = ~((xx * yy - xy * xy > 0.0) & (xx + yy > 0.0))
        if folded.any():
            return int(np.argmax(folded))
    return None


@cache
def fold_radius(by: Coefficients) -> float:
    """Returns how far from the middle the radial part grows, infinite where it always does."""
    roots = np.roots([7.0 * by.k3, 5.0 * by.k2, 3.0 * by.k1, 1.0])
    squares = [root.real for root in roots if abs(root.imag) < 1e-12 and root.real > 0.0]
    return float(np.sqrt(min(squares))) if squares else float("inf")
