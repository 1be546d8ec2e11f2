"""Floor and walls as rectangles with tiles on them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import cv2
import numpy as np

from hilbed.scene import BeaconSpec, LightSpec, ScenerySpec
from hilbed.scene.scenery import Rectangle, SurfaceSpec
from hilbed.types import Array, Image
from hilbed.vision.light import shade
from hilbed.vision.opengl import FAR, Vector
from hilbed.vision.textures import tile

COARSER = 4
"""How much coarser each image of a plane's tiles is than the one before."""
_COPIES = 4  # of the finest tile

_EVERYWHERE: Rectangle = (-FAR, -FAR), (FAR, FAR)


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
        return np.array(
            [self.corner, self.corner + width, self.corner + width + height, self.corner + height]
        )


def planes(spec: ScenerySpec, beacons: Sequence[BeaconSpec]) -> list[Plane]:
    """Returns the floor, to the walls or as far as the eye can see, and the walls from inside."""
    (x0, y0), (x1, y1) = _EVERYWHERE
    if spec.walls:
        (x0, y0), (x1, y1) = spec.walls.room([beacon.at for beacon in beacons])
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


def _plane(surface: SurfaceSpec, light: LightSpec, frame: Array, sides: tuple[float, float]) -> Plane:
    """frame: (3, 3) corner, right and up, one a row."""
    corner, right, up = frame
    normal: Vector = tuple(np.cross(right, up).tolist())
    tiles = [np.asarray(cv2.convertScaleAbs(tile(surface), alpha=shade(light, normal)), np.uint8)]
    while len(tiles[-1]) > 1:
        size = len(tiles[-1]) // COARSER
        tiles.append(np.asarray(cv2.resize(tiles[-1], (size, size), interpolation=cv2.INTER_AREA), np.uint8))
    copies = [_COPIES * 2**level if len(one) > 1 else 1 for level, one in enumerate(tiles)]
    images = [_repeated(one, n) for one, n in zip(tiles, copies, strict=True)]
    return Plane(corner, right, up, sides, images, surface.tile, copies)


def _repeated(tile: Image, copies: int) -> Image:
    return np.tile(tile.reshape(len(tile), -1, 3), (copies, copies, 1))
