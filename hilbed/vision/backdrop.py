"""What lies behind all bodies: sky, floor and walls, drawn plane by plane without PyBullet.

In a frame of 640×64 TinyRenderer takes 4 ms for a floor. To a camera a plane is a homography, which OpenCV
draws in a tenth of that, and it looks the same behind the bodies of either renderer.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import sqrt

import cv2
import numpy as np

from hilbed.scene import BeaconSpec, ScenerySpec
from hilbed.types import Array, Image
from hilbed.vision.clip import Corners, HalfSpace, clip
from hilbed.vision.opengl import FAR, NEAR, Pinhole, axes
from hilbed.vision.planes import Plane, planes
from hilbed.vision.seams import Viewpoint

_SMOOTH = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
_BITS = 4  # after the point, in the corners of OpenCV's polygons
_COARSER = 2  # levels from one strip to the next: each a quarter as fine as the one before


class Backdrop:
    """Paints what lies behind the beacons as `lens` sees it."""

    def __init__(self, lens: Pinhole, spec: ScenerySpec, beacons: Sequence[BeaconSpec]) -> None:
        self._lens = lens
        self._sky = [round(255.0 * part) for part in spec.sky]
        self._planes = planes(spec, beacons)
        self._matrix = np.array([[lens.fx, 0.0, lens.cx], [0.0, lens.fy, lens.cy], [0.0, 0.0, 1.0]])
        self._frustum = _frustum(lens)

    def paint(self, view: Viewpoint) -> Image:
        """Returns (H, W, 3) RGB."""
        image = np.empty((self._lens.height, self._lens.width, 3), np.uint8)
        image[:] = self._sky
        forward, left, up = np.array(axes(view))
        turn, eye = np.array([-left, -up, forward]), np.array([view.x, view.y, view.z])
        for plane in self._planes:
            self._draw(image, plane, turn, eye)
        return image

    def _draw(self, image: Image, plane: Plane, turn: Array, eye: Array) -> None:
        """Draws a plane in strips, each in as many pixels a tile as can be told apart there.

        frame takes (u, v, 1), u and v along the plane's sides (m), to the camera's right, down and forward.
        """
        frame = np.column_stack((turn @ plane.right, turn @ plane.up, turn @ (plane.corner - eye)))
        offset = float(np.linalg.det(frame))  # of the plane from the eye, negative where it is seen
        if offset >= 0.0:
            return
        (width, height), square = plane.sides, ((0, 0), (1, 0), (1, 1), (0, 1))
        corners = clip([tuple(frame @ (u * width, v * height, 1.0)) for u, v in square], self._frustum)
        if not corners:
            return
        here = np.floor((eye - plane.corner) @ np.column_stack((plane.right, plane.up)) / plane.size)
        frame[:, 2] += frame[:, :2] @ here * plane.size  # OpenCV counts no more than 32767 pixels of a texture
        depths = [z for *_, z in corners]
        for texture, start, end in _strips(plane, self._lens.fx * sqrt(-offset)):
            if end > min(depths) and start < max(depths):
                strip = clip(corners, [(0.0, 0.0, 1.0, -start), (0.0, 0.0, -1.0, end)])
                if strip:
                    self._fill(image, strip, texture, frame * (plane.size, plane.size, 1.0))

    def _fill(self, image: Image, corners: Corners, texture: Image, frame: Array) -> None:
        """Fills a polygon in the camera's axes; frame takes (tiles, tiles, 1) to them."""
        points = np.array(corners) @ self._matrix.T
        pixels = points[:, :2] / points[:, 2:]
        if len(texture) == 1:
            polygon = np.rint(pixels * (1 << _BITS)).astype(np.int32)
            cv2.fillConvexPoly(image, polygon, texture[0, 0].tolist(), cv2.LINE_8, _BITS)
            return
        left, top = np.maximum(np.floor(pixels.min(axis=0)).astype(int), 0).tolist()
        right, bottom = (np.ceil(pixels.max(axis=0)).astype(int) + 1).tolist()
        part = image[top:bottom, left:right]
        if part.size == 0:
            return
        polygon = np.rint((pixels - (left, top)) * (1 << _BITS)).astype(np.int32)
        mask = np.zeros(part.shape[:2], np.uint8)
        cv2.fillConvexPoly(mask, polygon, 255, cv2.LINE_8, _BITS)
        texels = np.array([[len(texture), 0.0, -0.5], [0.0, -len(texture), -0.5], [0.0, 0.0, 1.0]])
        shift = np.array([[1.0, 0.0, left], [0.0, 1.0, top], [0.0, 0.0, 1.0]])
        back = texels @ np.linalg.inv(self._matrix @ frame) @ shift
        seen = cv2.warpPerspective(
            texture, back, part.shape[1::-1], flags=_SMOOTH, borderMode=cv2.BORDER_WRAP
        )
        cv2.copyTo(seen, mask, part)


def _strips(plane: Plane, scale: float) -> Iterator[tuple[Image, float, float]]:
    """Yields the plane's tiles, finest first, and from where to where (m, depth) each is right.

    A pixel covers depth/f of a plane across, and depth²/(f·offset) along it; taken is the geometric mean of
    both. scale: f √offset.
    """
    texel = plane.size / len(plane.tiles[0])
    start = NEAR
    for level in range(0, len(plane.tiles), _COARSER):
        last = level + _COARSER >= len(plane.tiles)
        end = 2.0 * FAR if last else (texel * 2.0 ** (level + _COARSER / 2) * scale) ** (2.0 / 3.0)
        if end > start:
            yield plane.tiles[level], start, end
            start = end


def _frustum(lens: Pinhole) -> list[HalfSpace]:
    """Returns the half spaces that a camera sees, a pixel wider than its frame."""
    left, right = (-1.0 - lens.cx) / lens.fx, (lens.width - lens.cx) / lens.fx
    top, bottom = (-1.0 - lens.cy) / lens.fy, (lens.height - lens.cy) / lens.fy
    return [
        (0.0, 0.0, 1.0, -NEAR),
        (1.0, 0.0, -left, 0.0), (-1.0, 0.0, right, 0.0),
        (0.0, 1.0, -top, 0.0), (0.0, -1.0, bottom, 0.0),
    ]  # fmt: skip
