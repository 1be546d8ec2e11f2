"""From a point of the image to a direction about the pan axis and back, for any lens."""

from __future__ import annotations

from math import cos, sin
from typing import TYPE_CHECKING

import numpy as np

from hilbed.types import Array
from hilbed.vision.distortion import distort, fold_radius, undistort

if TYPE_CHECKING:
    from hilbed.vision.lens import Lens


def direction(lens: Lens, column: float | Array, row: float | Array) -> tuple[Array, Array]:
    """Returns azimuth and elevation (rad) along which points of the image look."""
    x, y = np.broadcast_arrays((column - lens.cx) / lens.fx, (row - lens.cy) / lens.fy)
    if lens.distorted:
        x, y = undistort(x, y, lens.coefficients)
    forward, left, up = _turned(lens, x, y)
    return np.arctan2(left, forward), np.arctan2(up, np.hypot(forward, left))


def pixel(lens: Lens, azimuth: float | Array, elevation: float | Array) -> tuple[Array, Array]:
    """Returns column and row that look in a direction; NaN where none does."""
    level = np.cos(elevation)
    ray = np.stack(np.broadcast_arrays(level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation)))
    forward, left, up = np.tensordot(mounting(lens).T, ray, 1)
    with np.errstate(all="ignore"):
        x, y = np.where(forward > 0.0, (-left / forward, -up / forward), np.nan)
        if lens.distorted:
            x, y = np.where(np.hypot(x, y) < fold_radius(lens.coefficients), (x, y), np.nan)
            x, y = distort(x, y, lens.coefficients)
    return lens.cx + lens.fx * x, lens.cy + lens.fy * y


def mounting(lens: Lens) -> Array:
    """Returns the turn (3, 3) from the camera's forward, left, up to the pan axis': Ry(tilt) Rx(roll)."""
    ct, st, cr, sr = cos(lens.tilt), sin(lens.tilt), cos(lens.roll), sin(lens.roll)
    return np.array([[ct, st * sr, st * cr], [0.0, cr, -sr], [-st, ct * sr, ct * cr]])


def _turned(lens: Lens, x: Array, y: Array) -> tuple[Array, Array, Array]:
    """Returns forward, left, up (about the pan axis) of the rays through x, y of the pinhole's image."""
    if lens.upright:
        return np.ones_like(x), -x, -y
    forward, left, up = np.tensordot(mounting(lens), np.stack((np.ones_like(x), -x, -y)), 1)
    return forward, left, up
