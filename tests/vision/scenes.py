"""Scenes for the tests of vision, and a projection that shares no code with the renderer or the detector."""

from __future__ import annotations

from math import cos, pi, sin

import cv2
import numpy as np

from hilbed.cost import Cost
from hilbed.scene import BeaconSpec
from hilbed.types import Array, Image
from hilbed.vision.lens import Lens
from hilbed.vision.render import BulletRenderer, Scenery
from hilbed.vision.seams import Shot, Viewpoint

WIDE = Lens.of_fov(640, 64, pi / 2)
AHEAD = Viewpoint(0.0, 0.0, 0.3, 0.0)
COLOURS = ("red", "orange", "green", "azure", "magenta", "yellow")


def beacon(azimuth: float, distance: float, colour: str = "red", **shape: float) -> BeaconSpec:
    at = (distance * cos(azimuth), distance * sin(azimuth))
    return BeaconSpec.model_validate({"at": at, "colour": colour, **shape})


def renderer(beacons: list[BeaconSpec], lens: Lens = WIDE, egl: bool = False) -> BulletRenderer:
    return BulletRenderer(lens, Scenery(beacons, egl), Cost())


def shot(image: Image, lens: Lens = WIDE) -> Shot:
    return Shot(image, 0, lens)


def project(points: Array, lens: Lens, eye: tuple[float, float, float], yaw: float) -> Array:
    """Returns the pixels (n, 2) of points (n, 3) in the map, by OpenCV."""
    c, s = cos(yaw), sin(yaw)
    turn = np.array([[s, -c, 0.0], [0.0, 0.0, -1.0], [c, s, 0.0]])  # map to OpenCV's right, down, forward
    rotation, _ = cv2.Rodrigues(turn)
    pixels, _ = cv2.projectPoints(points, rotation, -turn @ np.array(eye), lens.matrix, None)
    return np.asarray(pixels, float).reshape(-1, 2)


def axis(spec: BeaconSpec) -> Array:
    """Returns foot and top of a beacon's axis (2, 3)."""
    return np.array([(*spec.at, 0.0), (*spec.at, spec.height)])


def outline(spec: BeaconSpec, lens: Lens, eye: tuple[float, float, float], yaw: float) -> Array:
    """Returns the convex hull (n, 2) in pixels of a round truncated cone."""
    turn = np.linspace(0.0, 2.0 * pi, 721)
    rims = [
        np.column_stack((spec.at[0] + r * np.cos(turn), spec.at[1] + r * np.sin(turn), np.full_like(turn, h)))
        for r, h in ((spec.foot_radius, 0.0), (spec.top_radius, spec.height))
    ]
    hull = cv2.convexHull(project(np.vstack(rims), lens, eye, yaw).astype(np.float32))
    return np.asarray(hull, float).reshape(-1, 2)
