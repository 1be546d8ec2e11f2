"""Cuts a convex polygon to what lies in half spaces (Sutherland and Hodgman)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

Corners: TypeAlias = Sequence[tuple[float, ...]]
HalfSpace: TypeAlias = tuple[float, float, float, float]


def clip(corners: Corners, spaces: Sequence[HalfSpace]) -> Corners:
    """Returns the corners (x, y, z) of the part where ax + by + cz + d ≥ 0 for every (a, b, c, d)."""
    for a, b, c, d in spaces:
        depths = [a * x + b * y + c * z + d for x, y, z in corners]
        if min(depths) < 0.0:
            corners = _cut(corners, depths)
            if len(corners) < 3:
                return []
    return corners


def _cut(corners: Corners, depths: Sequence[float]) -> Corners:
    """Returns the corners of the part that is not outside; depths: how far inside each corner is."""
    (u, v, w), s = corners[-1], depths[-1]
    kept: list[tuple[float, ...]] = []
    for corner, r in zip(corners, depths, strict=True):
        x, y, z = corner
        if (s >= 0.0) != (r >= 0.0):
            part = s / (s - r)
            kept.append((u + part * (x - u), v + part * (y - v), w + part * (z - w)))
        if r >= 0.0:
            kept.append(corner)
        u, v, w, s = x, y, z, r
    return kept
