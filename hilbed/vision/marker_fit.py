"""Lays a marker as it should look over the image: all its edges tell where it is, not the four outer ones."""

from __future__ import annotations

from functools import cache

import cv2
import numpy as np

from hilbed.types import Array, Image

MARGIN = 2
"""Pixels around the marker that take part."""

_CELL = 8  # pixels
_FINE = 4  # parts of a pixel's side over which the marker is averaged
_FARTHEST = 1.0  # pixels: what moves farther has found something else
_UNTIL = (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_COUNT, 30, 1e-4)


def constant(family: str) -> int:
    """Returns OpenCV's number of a dictionary."""
    return int(getattr(cv2.aruco, f"DICT_{family}"))


def fitted(grey: Image, family: str, number: int, corners: Array) -> Array:
    """Returns corners (4, 2), pixels, moved to where the whole marker fits an (H, W) image best.

    By cv2.findTransformECC (Evangelidis and Psarakis, 2008); the corners stay where it finds nothing better
    within a pixel.
    """
    low = np.maximum(np.floor(corners.min(axis=0)).astype(int) - MARGIN, 0)
    high = np.minimum(np.ceil(corners.max(axis=0)).astype(int) + MARGIN + 1, grey.shape[::-1])
    piece = np.ascontiguousarray(grey[low[1] : high[1], low[0] : high[0]])
    expected = _drawn(family, number, corners - low, piece.shape)
    shift = np.eye(2, 3, dtype=np.float32)
    try:
        _, found = cv2.findTransformECC(
            expected, piece, shift, cv2.MOTION_TRANSLATION, _UNTIL, np.full_like(piece, 255), 1
        )
    except cv2.error:  # it does not converge
        return corners
    moved = np.asarray(found, float)[:, 2]
    return corners + moved if np.linalg.norm(moved) <= _FARTHEST else corners


def _drawn(family: str, number: int, corners: Array, shape: tuple[int, ...]) -> Image:
    """Returns an image of a marker with its corners at these pixels, each pixel the mean over its square."""
    cells = _cells(family, number)
    first, last = _CELL - 0.5, cells.shape[0] - _CELL - 0.5
    square = np.array([(first, first), (last, first), (last, last), (first, last)], np.float32)
    there = (_FINE * (corners + 0.5) - 0.5).astype(np.float32)
    height, width = shape
    large = cv2.warpPerspective(
        cells,
        cv2.getPerspectiveTransform(square, there),
        (_FINE * width, _FINE * height),
        flags=cv2.INTER_NEAREST,
        borderMode=cv2.BORDER_REPLICATE,
    )
    return np.asarray(cv2.resize(large, (width, height), interpolation=cv2.INTER_AREA), np.uint8)


@cache
def _cells(family: str, number: int) -> Image:
    """Returns (n, n), black 0 and white 255, of a marker with a white margin of one cell."""
    dictionary = cv2.aruco.getPredefinedDictionary(constant(family))
    cells = cv2.aruco.generateImageMarker(dictionary, number, _CELL * (dictionary.markerSize + 2))
    return np.pad(np.asarray(cells, np.uint8), _CELL, constant_values=255)
