"""Angles live in (−π, π]."""

from __future__ import annotations

from math import pi, remainder, tau


def wrap(angle: float) -> float:
    """Returns the angle (rad) in (−π, π]."""
    wrapped = remainder(angle, tau)
    return pi if wrapped == -pi else wrapped
