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

COARSER = 4
"""How much coarser each image of a plane's tiles is than the one before."""
_COPIES = 4  # of the finest tile

Corner = tuple[float, float]


class Plane(NamedTuple):
    """A rectangle: one corner (m, map), unit vectors along its sides, their lengths (m), and its tiles.

    It is seen from where right × up points. tiles: finest first, then each at a quarter of the pixels along
    both sides, down to one, for what is farther away; size: m that a tile covers; copies: how many there are
    of it along each side of an image, as OpenCV is five times slower where it has to repeat one.
    """

    corner: Array
    right: Array
    up: Array
    sides: tuple[float, float]
    tiles: list[Image]
    size: float
    copies: list[int]

    @property
    def corners(self) -> Array:
        """(4, 3) m in the map."""
        width, height = self.sides[0] * self.right, self.sides[1] * self.up
        return np.array([self.corner, self.corner + width, self.corner + width + height, self.corner + height])


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
        size = len(tiles[-1]) // COARSER
        tiles.append(np.asarray(cv2.resize(tiles[-1], (size, size), interpolation=cv2.INTER_AREA), np.uint8))
    copies = [_COPIES * 2**level if len(tile) > 1 else 1 for level, tile in enumerate(tiles)]
    images = [np.tile(tile.reshape(len(tile), -1, 3), (n, n, 1)) for tile, n in zip(tiles, copies, strict=True)]
    return Plane(corner, right, up, sides, images, surface.tile, copies)
