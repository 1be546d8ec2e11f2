"""Which way the edges of runs look, as the geometry of an upright axis needs it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from hilbed.types import Array
from hilbed.vision.edges import Edges
from hilbed.vision.lens import Lens
from hilbed.vision.runs import Indices


class Rays(NamedTuple):
    """Azimuth (rad) and tangent of the depression of the left and of the right edge of each run, all (n,)."""

    left: Array
    right: Array
    low: Array
    high: Array


def rays(lens: Lens, edges: Edges, row: Indices) -> Rays:
    """Returns which way both edges look."""
    if lens.upright and not lens.distorted:
        drop = np.asarray((row - lens.cy) / lens.fy, float)
        left = np.asarray(np.arctan((lens.cx - edges.left) / lens.fx))
        right = np.asarray(np.arctan((lens.cx - edges.right) / lens.fx))
        return Rays(left, right, drop * np.cos(left), drop * np.cos(right))
    azimuth, elevation = lens.direction(np.concatenate(edges[:2]), np.tile(row, 2).astype(float))
    depression = -np.tan(elevation)
    return Rays(*np.split(azimuth, 2), *np.split(depression, 2))


def steepness(lens: Lens, column: Array, row: Indices) -> Array:
    """Returns how steeply (tangent, positive) points of the image look down or up in its middle's plane.

    What distortion changes in that is left out.
    """
    if lens.upright:
        return np.asarray(np.abs((row - lens.cy) / lens.fy))
    azimuth, elevation = lens.direction(column, row.astype(float))
    return np.asarray(np.abs(np.tan(elevation) / np.cos(azimuth)))


def pixel_angle(lens: Lens, azimuth: Array, width: Array, angle: Array) -> Array:
    """Returns the angle (rad) of a pixel at each azimuth, where `width` pixels span `angle`."""
    if lens.upright and not lens.distorted:
        return np.asarray(np.cos(azimuth) ** 2 / lens.fx)
    return np.asarray(angle / width)


def places(lens: Lens, azimuth: Array, depression: Array, row: Array) -> tuple[Array, Array]:
    """Returns columns and rows of what is seen there; depression: its tangent; row: that of its middle."""
    if lens.upright and not lens.distorted:
        return np.array([lens.column(one) for one in azimuth.tolist()]), row
    return lens.pixel(azimuth, -np.arctan(depression))


def leans(lens: Lens, azimuth: Array, low: Array, high: Array) -> Array:
    """Returns how many columns lie between points of an upright axis; low, high: depressions' tangents."""
    column = lens.pixel(np.tile(azimuth, 2), -np.arctan(np.concatenate((low, high))))[0]
    return np.asarray(column[: azimuth.size] - column[azimuth.size :])
