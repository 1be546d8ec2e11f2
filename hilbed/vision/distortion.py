"""OpenCV's lens distortion and its inverse, on coordinates in units of the focal length.

x is right and y down, as in cv2.projectPoints: radial k1, k2, k3 and tangential p1, p2.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np

from hilbed.types import Array

_CONVERGED = 1e-11
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
    r2, xy = x * x + y * y, x * y
    radial = 1.0 + r2 * (by.k1 + r2 * (by.k2 + r2 * by.k3))
    return (
        x * radial + 2.0 * by.p1 * xy + by.p2 * (r2 + 2.0 * x * x),
        y * radial + by.p1 * (r2 + 2.0 * y * y) + 2.0 * by.p2 * xy,
    )


def slopes(x: Array, y: Array, by: Coefficients) -> tuple[Array, Array, Array]:
    """Returns ∂x'/∂x, ∂y'/∂y and ∂x'/∂y = ∂y'/∂x of `distort`."""
    r2 = x * x + y * y
    radial = 1.0 + r2 * (by.k1 + r2 * (by.k2 + r2 * by.k3))
    bend = 2.0 * (by.k1 + r2 * (2.0 * by.k2 + 3.0 * r2 * by.k3))
    return (
        radial + bend * x * x + 2.0 * by.p1 * y + 6.0 * by.p2 * x,
        radial + bend * y * y + 6.0 * by.p1 * y + 2.0 * by.p2 * x,
        bend * x * y + 2.0 * by.p1 * x + 2.0 * by.p2 * y,
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
            at_x, at_y = distort(u, v, by)
            off_x, off_y = at_x - x, at_y - y
            if max(np.max(np.abs(off_x), initial=0.0), np.max(np.abs(off_y), initial=0.0)) < _CONVERGED:
                return u, v
            xx, yy, xy = slopes(u, v, by)
            det = xx * yy - xy * xy
            u, v = u - (yy * off_x - xy * off_y) / det, v - (xx * off_y - xy * off_x) / det
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
