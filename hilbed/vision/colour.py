"""Which beacon's colour a pixel has: judged by hue, so that shading does not matter."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
import numpy.typing as npt

from hilbed.scene import COLOURS
from hilbed.types import Image

Labels = npt.NDArray[np.uint8]

BACKGROUND, OTHER = 0, 255  # of the labels, which are masked bit by bit
HUES = 180  # OpenCV counts hue in steps of 2°
NEAREST = 15.0 / 2.0  # half the distance between the hues of two beacons
_LEAST_SATURATION, _LEAST_VALUE = 100, 40  # below either a pixel has no colour


class Palette:
    """The colours to look for: label k + 1 belongs to the k-th of `colours`."""

    def __init__(self, colours: Sequence[str]) -> None:
        self.colours = tuple(dict.fromkeys(colours))
        if len(self.colours) >= OTHER:
            raise ValueError("more colours than labels")
        self._labels = np.zeros((1, 256, 3), np.uint8)  # by hue; all bits where saturation, value are enough
        self._labels[0, :, 0] = [self._label(hue) for hue in range(256)]
        self._labels[0, _LEAST_SATURATION:, 1] = self._labels[0, _LEAST_VALUE:, 2] = 255

    def label(self, pixels: Image) -> Labels:
        """Returns (n,) for (1, n, 4) RGBA: BACKGROUND, a colour's label, or OTHER for any other colour."""
        hsv = cv2.LUT(cv2.cvtColor(pixels, cv2.COLOR_RGB2HSV), self._labels)[0]
        return np.asarray(hsv[:, 0] & hsv[:, 1] & hsv[:, 2], np.uint8)

    def _label(self, hue: int) -> int:
        distances = [abs((hue - _hue(colour) + HUES / 2) % HUES - HUES / 2) for colour in self.colours]
        nearest = min(range(len(distances)), key=distances.__getitem__, default=-1)
        return nearest + 1 if nearest >= 0 and distances[nearest] <= NEAREST else OTHER


def _hue(colour: str) -> float:
    pixel = np.array([[COLOURS[colour]]], np.float32)
    return float(cv2.cvtColor(pixel, cv2.COLOR_RGB2HSV)[0, 0, 0]) / 2.0
