"""One image from a file, whole and of three channels, or a message that says what it is instead."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np

from hilbed.types import Image, ScenarioError

SUFFIXES = (".png", ".jpg", ".jpeg")

_PNG, _PNG_END = b"\x89PNG\r\n\x1a\n", b"IEND\xaeB`\x82"
_JPEG, _JPEG_SCAN, _JPEG_END = b"\xff\xd8", b"\xff\xda", b"\xff\xd9"


def read_image(path: Path) -> Image:
    """Returns a PNG or JPEG as (H, W, 3) RGB; one of a single channel is grey.

    Raises ScenarioError naming the file where it cannot be read, is cut off, or has other channels than three
    or one of 8 bits.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise ScenarioError(f"{path}: {error.strerror}") from None
    return decode(data, str(path))


def decode(data: bytes, name: str) -> Image:
    """Returns an encoded image as (H, W, 3) RGB; raises ScenarioError; name: for its message."""
    if _cut_off(data):
        raise ScenarioError(f"{name}: the image is cut off after {len(data)} bytes")
    try:
        image = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED) if data else None
    except cv2.error:
        image = None
    if image is None:
        raise ScenarioError(f"{name}: is no image that can be read")
    return rgb(np.asarray(image), name)


def rgb(image: np.ndarray, name: str) -> Image:
    """Returns an image of OpenCV's (BGR or grey, 8 bits) as (H, W, 3) RGB; raises ScenarioError."""
    channels = 1 if image.ndim == 2 else image.shape[2]
    if image.dtype != np.uint8:
        raise ScenarioError(f"{name}: has {8 * image.dtype.itemsize} bits a channel, a frame has 8")
    if channels not in (1, 3):
        raise ScenarioError(f"{name}: has {channels} channels, a frame has 3 (or 1, grey)")
    code = cv2.COLOR_GRAY2RGB if channels == 1 else cv2.COLOR_BGR2RGB
    return np.asarray(cv2.cvtColor(image, code), np.uint8)


def _cut_off(data: bytes) -> bool:
    """Tells whether the end of a PNG or JPEG is missing, which OpenCV fills up with grey."""
    if data.startswith(_PNG):
        return _PNG_END not in data[-64:]
    return data.startswith(_JPEG) and data.rfind(_JPEG_END) < data.rfind(_JPEG_SCAN)
