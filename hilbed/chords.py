"""The straight way between the ends of an arc."""

from __future__ import annotations

from math import cos, sin

SMALL = 1e-4  # rad: below it the series of sin(h)/h is exact to rounding


def sinc(h: float) -> float:
    """Returns sin(h)/h, 1 at h = 0."""
    return sin(h) / h if abs(h) > SMALL else 1.0 - h * h / 6.0


def sinc_slope(h: float) -> float:
    """Returns the derivative (cos(h) − sin(h)/h)/h of sin(h)/h, 0 at h = 0."""
    return (cos(h) - sin(h) / h) / h if abs(h) > 1e-3 else -h / 3.0


def chord(distance: float, turn: float) -> tuple[float, float]:
    """Returns length (m) and direction (rad, from the heading at the start) of an arc of a way and a turn.

    l = s sin(h)/h at h, half the turn: Lages & Alves (2017), eq. (2).
    """
    return distance * sinc(0.5 * turn), 0.5 * turn
