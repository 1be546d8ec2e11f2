"""Cuts a convex polygon to what lies in half spaces (Sutherland and Hodgman)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

Corners: TypeAlias = Sequence[tuple[float, ...]]
HalfSpace: TypeAlias = tuple[float, float, float, float]


def clip(corners: Corners, spaces: Sequence[HalfSpace]) -> Corners:
    """Returns the corners (x, y, z) of the part where ax + by + cz + d ≥ 0 for every (a, b, c, d)."""
    for a, b, c, d in spaces:
        inside = [a * x + b * y + c * z + d for x, y, z in corners]
        kept: list[tuple[float, ...]] = []
        for k, corner in enumerate(corners):
            before, s, r = corners[k - 1], inside[k - 1], inside[k]
            if (s >= 0.0) != (r >= 0.0):
                kept.append(tuple(p + s / (s - r) * (q - p) for p, q in zip(before, corner, strict=True)))
            if r >= 0.0:
                kept.append(corner)
        corners = kept
        if len(corners) < 3:
            return []
    return corners
