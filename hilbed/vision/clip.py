"""Cuts a convex polygon to what lies in half spaces (Sutherland and Hodgman)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

Corners: TypeAlias = Sequence[tuple[float, ...]]
HalfSpace: TypeAlias = tuple[float, float, float, float]


def clip(corners: Corners, spaces: Sequence[HalfSpace]) -> Corners:
    """Returns the corners (x, y, z) of the part where ax + by + cz + d ≥ 0 for every (a, b, c, d)."""
    for a, b, c, d in spaces:
        u, v, w = corners[-1]
        s = a * u + b * v + c * w + d
        kept: list[tuple[float, ...]] = []
        for corner in corners:
            x, y, z = corner
            r = a * x + b * y + c * z + d
            if (s >= 0.0) != (r >= 0.0):
                part = s / (s - r)
                kept.append((u + part * (x - u), v + part * (y - v), w + part * (z - w)))
            if r >= 0.0:
                kept.append(corner)
            u, v, w, s = x, y, z, r
        corners = kept
        if len(corners) < 3:
            return []
    return corners
