"""Which way the edges of runs look, as the geometry of an upright axis needs it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from hilbed.types import Array
from hilbed.vision.lens import Lens
from hilbed.vision.runs import Indices


class Rays(NamedTuple):
    """Azimuth (rad) and tangent of the depression of the left and of the right edge of each run, all (n,)."""

    left: Array
    right: Array
    low: Array
    high: Array


def rays(lens: Lens, columns: Array, row: Indices) -> Rays:
    """Returns which way both edges (columns (2, n)) of the runs in these rows look."""
    if lens.plain:
        azimuth = np.arctan((lens.cx - columns) / lens.fx)
        return Rays(*azimuth, *(np.cos(azimuth) * ((row - lens.cy) / lens.fy)))
    azimuth, elevation = lens.direction(columns.ravel(), np.tile(row, 2).astype(float))
    return Rays(*azimuth.reshape(2, -1), *-np.tan(elevation).reshape(2, -1))


def steepness(lens: Lens, column: float | Array, row: Indices) -> Array:
    """Returns how steeply (tangent, positive) points of the image look down or up in its middle's plane.

    What distortion changes in that is left out, and the column does not matter to an upright lens.
    """
    if lens.upright:
        return np.asarray(np.abs((row - lens.cy) / lens.fy))
    azimuth, elevation = lens.direction(column, row.astype(float))
    return np.asarray(np.abs(np.tan(elevation) / np.cos(azimuth)))


def places(lens: Lens, azimuth: Array, depression: Array, row: Array) -> tuple[Array, Array]:
    """Returns columns and rows of what is seen there; depression: its tangent; row: that of its middle."""
    if lens.plain:
        return np.array([lens.column(one) for one in azimuth.tolist()]), row
    return lens.pixel(azimuth, -np.arctan(depression))


def leans(lens: Lens, azimuth: Array, low: Array, high: Array) -> Array:
    """Returns how many columns lie between points of an upright axis; low, high: depressions' tangents."""
    column = lens.pixel(np.tile(azimuth, 2), -np.arctan(np.concatenate((low, high))))[0]
    return np.asarray(column[: azimuth.size] - column[azimuth.size :])
