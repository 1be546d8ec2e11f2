"""What a camera must see, by OpenCV and by brute force: shares no code with renderer and backdrop."""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np
from scipy.spatial.transform import Rotation

from hilbed.scene import BeaconSpec
from hilbed.types import Array, Image
from hilbed.vision.seams import Viewpoint


class Pin(NamedTuple):
    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float

    @property
    def matrix(self) -> Array:
        return np.array([[self.fx, 0.0, self.cx], [0.0, self.fy, self.cy], [0.0, 0.0, 1.0]])


SKEWED = Pin(320, 200, 190.0, 240.0, 130.25, 61.5)
"""A camera whose axis is nowhere near the middle and whose pixels are not square."""


def turn(view: Viewpoint) -> Array:
    """Returns the rotation from the map to OpenCV's right, down, forward."""
    body = Rotation.from_euler("ZYX", [view.yaw, view.pitch, view.roll]).as_matrix()
    return np.asarray(np.array([[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]]) @ body.T)


def pixels(points: Array, pin: Pin, view: Viewpoint) -> Array:
    """Returns the pixels (n, 2) of points (n, 3) in the map."""
    rotation = turn(view)
    vector, _ = cv2.Rodrigues(rotation)
    eye = np.array([view.x, view.y, view.z])
    found, _ = cv2.projectPoints(points, vector, -rotation @ eye, pin.matrix, None)
    return np.asarray(found, float).reshape(-1, 2)


def rays(pin: Pin, view: Viewpoint) -> Array:
    """Returns the directions (H, W, 3) in the map along which the pixels look."""
    column, row = np.meshgrid(np.arange(pin.width), np.arange(pin.height))
    seen = np.stack(((column - pin.cx) / pin.fx, (row - pin.cy) / pin.fy, np.ones_like(column)), axis=-1)
    return np.asarray(seen @ turn(view))


def surface(spec: BeaconSpec) -> Array:
    """Returns points (n, 3) in the map all over a round beacon."""
    x, y = spec.at
    around = np.linspace(0.0, 2.0 * np.pi, 241)
    if spec.shape == "sphere":
        centre = spec.height - spec.foot_radius
        polar = np.linspace(0.0, np.pi, 91)[:, None]
        ring = spec.foot_radius * np.sin(polar)
        z = np.broadcast_to(centre + spec.foot_radius * np.cos(polar), (91, 241))
        return np.stack((x + ring * np.cos(around), y + ring * np.sin(around), z), axis=-1).reshape(-1, 3)
    top = spec.top_radius if spec.shape == "cone" else spec.foot_radius
    rims = [
        np.column_stack((x + r * np.cos(around), y + r * np.sin(around), np.full_like(around, z)))
        for r, z in ((spec.foot_radius, 0.0), (top, spec.height))
    ]
    return np.vstack(rims)


def depths(spec: BeaconSpec, pin: Pin, view: Viewpoint) -> Array:
    """Returns (H, W) how far (pixels) each pixel's centre lies inside the outline of a round beacon."""
    hull = cv2.convexHull(pixels(surface(spec), pin, view).astype(np.float32))
    found = [
        cv2.pointPolygonTest(hull, (float(column), float(row)), True)
        for row, column in np.ndindex(pin.height, pin.width)
    ]
    return np.array(found).reshape(pin.height, pin.width)


def room(pin: Pin, view: Viewpoint, size: tuple[float, float, float], sky: int = 0) -> Image:
    """Returns (H, W): 1 floor, 2 wall, 0 sky, in a room ±x, ±y of height z."""
    ray, eye = rays(pin, view), np.array([view.x, view.y, view.z])
    with np.errstate(divide="ignore", invalid="ignore"):
        floor = np.where(ray[..., 2] < 0.0, -eye[2] / ray[..., 2], np.inf)
        ways = [
            np.where(sign * ray[..., k] > 0.0, (sign * size[k] - eye[k]) / ray[..., k], np.inf)
            for k in (0, 1)
            for sign in (-1.0, 1.0)
        ]
        wall = np.min(ways, axis=0)
    top = eye[2] + wall * ray[..., 2]
    return np.where(floor < wall, 1, np.where(top < size[2], 2, sky)).astype(np.uint8)
