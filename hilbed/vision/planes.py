"""Floor and walls as rectangles with tiles on them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import cv2
import numpy as np

from hilbed.scene import BeaconSpec, LightSpec, ScenerySpec, WallsSpec
from hilbed.scene.scenery import SurfaceSpec
from hilbed.types import Array, Image
from hilbed.vision.light import shade
from hilbed.vision.opengl import FAR, Vector
from hilbed.vision.textures import tile

Corner = tuple[float, float]


class Plane(NamedTuple):
    """A rectangle: one corner (m, map), unit vectors along its sides, their lengths (m), and its tiles.

    It is seen from where right × up points. tiles: the same again in 1, 1/2, 1/4 … of the pixels along each
    side, down to one, for what is farther away; size: m that each covers.
    """

    corner: Array
    right: Array
    up: Array
    sides: tuple[float, float]
    tiles: list[Image]
    size: float


def planes(spec: ScenerySpec, beacons: Sequence[BeaconSpec]) -> list[Plane]:
    """Returns the floor, to the walls or as far as the eye can see, and the walls from inside."""
    (x0, y0), (x1, y1) = room(spec.walls, beacons) if spec.walls else ((-FAR, -FAR), (FAR, FAR))
    found = []
    if spec.floor:
        corner = np.array([[x0, y0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
        found.append(_plane(spec.floor, spec.light, corner, (x1 - x0, y1 - y0)))
    if spec.walls:
        for start, along, length in (
            ((x0, y0), (0.0, 1.0), y1 - y0),
            ((x0, y1), (1.0, 0.0), x1 - x0),
            ((x1, y1), (0.0, -1.0), y1 - y0),
            ((x1, y0), (-1.0, 0.0), x1 - x0),
        ):
            corner = np.array([[*start, 0.0], [*along, 0.0], [0.0, 0.0, 1.0]])
            found.append(_plane(spec.walls, spec.light, corner, (length, spec.walls.height)))
    return found


def room(walls: WallsSpec, beacons: Sequence[BeaconSpec]) -> tuple[Corner, Corner]:
    """Returns the corners (m, map) of least and of largest x and y between the walls."""
    if walls.corner and walls.opposite:
        return walls.corner, walls.opposite
    xs, ys = [b.at[0] for b in beacons] or [0.0], [b.at[1] for b in beacons] or [0.0]
    margin = walls.margin
    return (min(xs) - margin, min(ys) - margin), (max(xs) + margin, max(ys) + margin)


def _plane(surface: SurfaceSpec, light: LightSpec, frame: Array, sides: tuple[float, float]) -> Plane:
    """frame: (3, 3) corner, right and up, one a row."""
    corner, right, up = frame
    normal: Vector = tuple(np.cross(right, up).tolist())
    tiles = [cv2.convertScaleAbs(tile(surface), alpha=shade(light, normal))]
    while len(tiles[-1]) > 1:
        half = len(tiles[-1]) // 2
        tiles.append(np.asarray(cv2.resize(tiles[-1], (half, half), interpolation=cv2.INTER_AREA), np.uint8))
    return Plane(corner, right, up, sides, [t.reshape(len(t), -1, 3) for t in tiles], surface.tile)
