"""How large a beacon's whole outline is in the image, as if nothing hid it and the image had no border."""

from __future__ import annotations

from math import cos, pi, sin

import cv2
import numpy as np

from hilbed.scene import BeaconSpec
from hilbed.types import Array
from hilbed.vision.distortion import distort, fold_radius
from hilbed.vision.lens import Lens
from hilbed.vision.opengl import NEAR, axes
from hilbed.vision.seams import Viewpoint

_TURNS = np.linspace(0.0, 2.0 * pi, 72, endpoint=False)
_STEPS = 8  # points a side of the hull, which a lens may bend
_FARTHEST = 1e4  # pixels off the middle


def middle_height(beacon: BeaconSpec) -> float:
    """Returns how high (m) the middle of a beacon's axis is."""
    return beacon.height - beacon.foot_radius if beacon.shape == "sphere" else beacon.height / 2.0


def pixels(beacon: BeaconSpec, view: Viewpoint, lens: Lens) -> int:
    """Returns the number of pixel centres inside the outline; those out of the image, too."""
    ahead = seen(points(beacon, view), view)
    if len(ahead) < 3:
        return 0
    hull = bent(cv2.convexHull(ahead.astype(np.float32)).reshape(-1, 2).astype(float), lens)
    corners = np.clip((lens.fx, lens.fy) * hull, -_FARTHEST, _FARTHEST) + np.array((lens.cx, lens.cy))
    return centres_inside(corners) if len(corners) > 2 else 0


def bent(hull: Array, lens: Lens) -> Array:
    """Returns a polygon (n, 2) as the lens distorts it, without what lies too far out."""
    if not lens.distorted:
        return hull
    ends = zip(hull, np.roll(hull, -1, 0), strict=True)
    x, y = np.concatenate([np.linspace(a, b, _STEPS, endpoint=False) for a, b in ends]).T
    inside = np.hypot(x, y) < fold_radius(lens.coefficients)
    return np.column_stack(distort(x[inside], y[inside], lens.coefficients))


def points(beacon: BeaconSpec, view: Viewpoint) -> Array:
    """Returns points (n, 3) of the map whose hull is the beacon's."""
    x, y = beacon.at
    r, h = beacon.foot_radius, beacon.height
    if beacon.shape == "sphere":
        rings = [(r * cos(a), h - r + r * sin(a)) for a in np.linspace(-pi / 2, pi / 2, 37)]
        return np.concatenate([ring(x, y, *one) for one in rings])
    low = h - 2.0 * r if beacon.marker is not None else 0.0
    if beacon.shape not in ("board", "box"):
        return np.concatenate((ring(x, y, r, low), ring(x, y, beacon.upper_radius, h)))
    facing = np.arctan2(view.y - y, view.x - x) if beacon.facing is None else beacon.facing
    c, s = cos(facing), sin(facing)
    deep = (r, -r) if beacon.shape == "box" else (0.0,)
    return np.array(
        [(x + c * f - s * w, y + s * f + c * w, z) for f in deep for w in (r, -r) for z in (low, h)]
    )


def ring(x: float, y: float, radius: float, height: float) -> Array:
    """Returns points (n, 3) of a level circle."""
    return np.column_stack(
        (x + radius * np.cos(_TURNS), y + radius * np.sin(_TURNS), np.full_like(_TURNS, height))
    )


def seen(points: Array, view: Viewpoint) -> Array:
    """Returns x (right), y (down) of the points in front of the camera, in units of the focal length."""
    forward, left, up = ((points - (view.x, view.y, view.z)) @ np.array(axes(view)).T).T
    ahead = forward > NEAR
    return np.column_stack((-left[ahead] / forward[ahead], -up[ahead] / forward[ahead]))


def centres_inside(corners: Array) -> int:
    """Returns how many points with whole coordinates lie inside a polygon (n, 2)."""
    (x, y), (x2, y2) = corners.T, np.roll(corners, -1, 0).T
    rows = np.arange(np.ceil(y.min()), np.floor(y.max()) + 1)[:, None]
    crosses = (y <= rows) != (y2 <= rows)
    with np.errstate(divide="ignore", invalid="ignore"):
        at = np.where(crosses, x + (rows - y) * (x2 - x) / (y2 - y), np.inf)
    at = np.sort(at, 1)
    begins, ends = at[:, 0 : at.shape[1] - 1 : 2], at[:, 1::2]
    inside = np.isfinite(ends)
    begins, ends = np.where(inside, begins, 1.0), np.where(inside, ends, 0.5)
    return int((np.floor(ends) - np.ceil(begins) + 1).sum())
