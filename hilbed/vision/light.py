"""Light on the scene, from dark to glare."""

from __future__ import annotations

from math import cos, sin, tan
from typing import Any

import cv2
import numpy as np

from hilbed.scene import LightSpec
from hilbed.types import Image
from hilbed.vision.opengl import Pinhole, Vector, axes
from hilbed.vision.seams import Viewpoint

_HALO = 6.0  # times the sun's own size
_WHITE = 255.0


def towards(light: LightSpec) -> Vector:
    """Returns the unit vector (map) to where the light comes from."""
    c = cos(light.elevation)
    return (c * cos(light.azimuth), c * sin(light.azimuth), sin(light.elevation))


def shade(light: LightSpec, normal: Vector) -> float:
    """Returns the brightness of a matt surface with a unit normal (map), 1 where light is undirected."""
    facing = sum(a * b for a, b in zip(towards(light), normal, strict=True))
    return 1.0 - light.directed + light.directed * max(facing, 0.0)


def bullet(light: LightSpec) -> dict[str, Any]:
    """Returns the light as PyBullet takes it; undirected, every colour is exact in TinyRenderer."""
    coefficients = {
        "shadow": 0,
        "lightAmbientCoeff": 1.0 - light.directed,
        "lightDiffuseCoeff": light.directed,
        "lightSpecularCoeff": 0.0,
    }
    return coefficients if light.directed == 0.0 else {**coefficients, "lightDirection": towards(light)}


class Glare:
    """What light does to the whole frame: its level, a veil over it, the sun where it is in view.

    Glare adds to what is seen, in linear steps of brightness, and burns out at white.
    """

    def __init__(self, lens: Pinhole, light: LightSpec) -> None:
        self._lens, self._light = lens, light
        self.plain = light.level == 1.0 and light.veil == 0.0 and light.sun == 0.0
        columns = (np.arange(lens.width) - lens.cx) / lens.fx
        rows = (np.arange(lens.height) - lens.cy) / lens.fy
        self._right, self._down = np.meshgrid(columns, rows)
        self._length = np.sqrt(self._right**2 + self._down**2 + 1.0)

    def over(self, image: Image, view: Viewpoint) -> Image:
        """Returns an (H, W, 3) RGB image as it is seen through the glare."""
        light = self._light
        image = np.asarray(cv2.convertScaleAbs(image, alpha=light.level, beta=_WHITE * light.veil), np.uint8)
        if not light.sun:
            return image
        spot = self._sun(view)
        return image if spot is None else np.asarray(cv2.add(image, cv2.merge([spot] * 3)), np.uint8)

    def _sun(self, view: Viewpoint) -> Image | None:
        """Returns (H, W) what sun and halo add, None where neither is in view.

        A disc of even brightness, then a halo that falls with the square of the distance from the middle.
        """
        forward, left, up = np.array(axes(view)) @ np.array(towards(self._light))
        cosine = (forward - left * self._right - up * self._down) / self._length
        size = self._light.size
        if cosine.max() < cos(min(_HALO * size, 1.5)):
            return None
        # 2 tan(a/2) of the angle from the middle: exact enough, and cheap from the cosine
        distance = 2.0 * np.sqrt(np.maximum(1.0 - cosine, 0.0) / np.maximum(1.0 + cosine, 1e-9))
        fall = np.clip(2.0 * tan(size / 2.0) / np.maximum(distance, 1e-9), 0.0, 1.0) ** 2
        edge = (1.0 / _HALO) ** 2
        return np.asarray(_WHITE * self._light.sun * np.maximum(fall - edge, 0.0) / (1.0 - edge), np.uint8)
