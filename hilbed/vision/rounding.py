"""What edges that are rounded to whole pixels leave of an azimuth's precision.

Measured on rendered cones from 1 to 9 m: rounding averages out the better the more pixel columns an edge
crosses. An edge that crosses none is off by 1/√12, two of them by 1/√24.
"""

from __future__ import annotations

from math import sqrt

_ROUNDING = 0.066
_UPRIGHT = 0.2


def of_steps(steps: int, part: float) -> float:
    """Returns the error (pixels) of an azimuth from rounded edges that cross as many columns.

    part: of the rounding that is left where edges are soft, as they show where they cross columns.
    """
    return _ROUNDING / (1 + steps) * part if steps > 0 else _UPRIGHT


def of_crossings(left: float, right: float, rows: int, part: float) -> float:
    """Returns the same for edges that cross these numbers of columns in so many rows.

    The mean of a sawtooth of ±1/2 over x ≥ 1 of its periods has a variance of f² (1 − f)² / (12 x²), f being
    the part of the last period: 1 / (360 x²) for any f. Within the first period it is (1 − x)² / 12. Taken
    on n rows, each of the x jumps is found to x / n of a period, which adds x / (12 n²).
    """

    def one(x: float) -> float:
        short, long = max(1.0 - x, 0.0), max(x, 1.0)
        first = short * short / 12.0
        later = part * part / 360.0 / (long * long)
        return max(first, later) + part * part * x / (12.0 * rows * rows)

    return 0.5 * sqrt(one(left) + one(right))
