"""What lies behind all bodies: sky, floor and walls, drawn plane by plane without PyBullet.

TinyRenderer computes every pixel of the box around each triangle, in a frame of 640×64 3 ms for a floor
however it is cut. To a camera a plane is a homography, which OpenCV draws in a tenth of that, and it looks
the same behind the bodies of either renderer.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import sqrt
from typing import TypeAlias

import cv2
import numpy as np

from hilbed.scene import BeaconSpec, ScenerySpec
from hilbed.types import Array, Image
from hilbed.vision.clip import Corners, HalfSpace, clip
from hilbed.vision.opengl import FAR, NEAR, Pinhole, Vector, axes
from hilbed.vision.planes import COARSER, Plane, planes
from hilbed.vision.seams import Viewpoint

Turn: TypeAlias = tuple[Vector, Vector, Vector]

_SMOOTH = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
_GRAZING = 1e-3  # m: an eye that is not farther from a plane does not see it
_BITS = 4  # after the point, in the corners of OpenCV's polygons


class Backdrop:
    """Paints what lies behind the beacons as `lens` sees it."""

    def __init__(self, lens: Pinhole, spec: ScenerySpec, beacons: Sequence[BeaconSpec]) -> None:
        self._lens = lens
        sky = [round(255.0 * part) for part in spec.sky]
        self._sky = np.full((lens.height, lens.width, 3), sky, np.uint8)
        self._planes = [
            (plane, plane.corners.tolist(), np.cross(plane.right, plane.up).tolist())
            for plane in planes(spec, beacons)
        ]
        self._matrix = np.array([[lens.fx, 0.0, lens.cx], [0.0, lens.fy, lens.cy], [0.0, 0.0, 1.0]])
        self._frustum = _frustum(lens)

    def paint(self, view: Viewpoint) -> Image:
        """Returns (H, W, 3) RGB."""
        image = self._sky.copy()
        forward, (lx, ly, lz), (ux, uy, uz) = axes(view)
        turn = (-lx, -ly, -lz), (-ux, -uy, -uz), forward
        for plane, square, offset in self._seen(view, turn):
            if square and len(plane.tiles) == 1:
                self._fill(image, square, plane.tiles[0])
            elif square:
                frame = _frame(plane, np.array(turn), np.array(view[:3]))
                self._cover(image, square, plane, offset, frame)
        return image

    def _seen(self, view: Viewpoint, turn: Turn) -> Iterator[tuple[Plane, Corners, float]]:
        """Yields planes that look at the eye, what the frame shows of each, and how far off each is (m)."""
        ex, ey, ez = view[:3]
        (a, b, c), (d, e, f), (g, h, i) = turn
        for plane, corners, (nx, ny, nz) in self._planes:
            there = [(x - ex, y - ey, z - ez) for x, y, z in corners]
            x, y, z = there[0]
            offset = -(x * nx + y * ny + z * nz)
            if offset > _GRAZING:
                square = [
                    (a * x + b * y + c * z, d * x + e * y + f * z, g * x + h * y + i * z) for x, y, z in there
                ]
                yield plane, clip(square, self._frustum), offset

    def _cover(self, image: Image, corners: Corners, plane: Plane, offset: float, frame: Array) -> None:
        """Draws a plane with a pattern in strips, each in as many pixels as can be told apart there."""
        depths = [z for *_, z in corners]
        back = np.linalg.inv(self._matrix @ frame)
        for level, near, far in _strips(plane, self._lens.fx * sqrt(offset)):
            if far > min(depths) and near < max(depths):
                strip = clip(corners, [(0.0, 0.0, 1.0, -near), (0.0, 0.0, -1.0, far)])
                texture = plane.tiles[level]
                if strip and len(texture) == 1:
                    self._fill(image, strip, texture)
                elif strip:
                    texels = _texels(len(texture), plane.copies[level])
                    self._texture(image, strip, texture, texels @ back)

    def _fill(self, image: Image, corners: Corners, colour: Image) -> None:
        """Fills a polygon, in the camera's axes, with one colour."""
        lens, one = self._lens, 1 << _BITS
        fx, fy, cx, cy = one * lens.fx, one * lens.fy, one * lens.cx, one * lens.cy
        polygon = [(round((fx * x + cx * z) / z), round((fy * y + cy * z) / z)) for x, y, z in corners]
        cv2.fillConvexPoly(image, np.array(polygon, np.int32), colour[0, 0].tolist(), cv2.LINE_8, _BITS)

    def _texture(self, image: Image, corners: Corners, texture: Image, back: Array) -> None:
        """Fills a polygon with a texture; back takes pixels of the image to those of the texture."""
        pixels = self._pixels(corners)
        left, top = np.maximum(np.floor(pixels.min(axis=0)).astype(int), 0).tolist()
        right, bottom = (np.ceil(pixels.max(axis=0)).astype(int) + 1).tolist()
        part = image[top:bottom, left:right]
        if part.size == 0:
            return
        mask = np.zeros(part.shape[:2], np.uint8)
        polygon = np.rint((pixels - (left, top)) * (1 << _BITS)).astype(np.int32)
        cv2.fillConvexPoly(mask, polygon, 255, cv2.LINE_8, _BITS)
        shift = np.array([[1.0, 0.0, left], [0.0, 1.0, top], [0.0, 0.0, 1.0]])
        size = part.shape[1], part.shape[0]
        filled = cv2.warpPerspective(texture, back @ shift, size, flags=_SMOOTH, borderMode=cv2.BORDER_WRAP)
        cv2.copyTo(filled, mask, part)

    def _pixels(self, corners: Corners) -> Array:
        """Returns (n, 2) of corners in the camera's axes."""
        points = np.array(corners) @ self._matrix.T
        return np.asarray(points[:, :2] / points[:, 2:])


def _frame(plane: Plane, turn: Array, eye: Array) -> Array:
    """Returns what takes (u, v, 1), in tiles from the one below the eye, to the camera's axes."""
    sides = np.column_stack((plane.right, plane.up)) * plane.size
    here = np.floor((eye - plane.corner) @ sides / plane.size**2)
    return np.asarray(turn @ np.column_stack((sides, plane.corner + sides @ here - eye)))


def _texels(size: int, copies: int) -> Array:
    """Returns what takes (u, v, 1), in tiles from the middle one on, to pixels of `copies` tiles a side."""
    tile, middle = size / copies, copies // 2
    return np.array(
        [[tile, 0.0, middle * tile - 0.5], [0.0, -tile, (copies - middle) * tile - 0.5], [0.0, 0.0, 1.0]]
    )


def _strips(plane: Plane, scale: float) -> Iterator[tuple[int, float, float]]:
    """Yields levels of the plane's tiles, finest first, and from where to where (m, depth) each is right.

    A pixel covers depth/f of a plane across, and depth²/(f·offset) along it; taken is the geometric mean of
    both. scale: f √offset.
    """
    texel = plane.size * plane.copies[0] / len(plane.tiles[0])
    near = NEAR
    for level in range(len(plane.tiles)):
        last = level == len(plane.tiles) - 1
        far = 2.0 * FAR if last else (texel * COARSER ** (level + 0.5) * scale) ** (2.0 / 3.0)
        if far > near:
            yield level, near, far
            near = far


def _frustum(lens: Pinhole) -> list[HalfSpace]:
    """Returns the half spaces that a camera sees, a pixel wider than its frame."""
    left, right = (-1.0 - lens.cx) / lens.fx, (lens.width - lens.cx) / lens.fx
    top, bottom = (-1.0 - lens.cy) / lens.fy, (lens.height - lens.cy) / lens.fy
    return [
        (1.0, 0.0, -left, 0.0), (-1.0, 0.0, right, 0.0),
        (0.0, 1.0, -top, 0.0), (0.0, -1.0, bottom, 0.0),
        (0.0, 0.0, 1.0, -NEAR),
    ]  # fmt: skip
