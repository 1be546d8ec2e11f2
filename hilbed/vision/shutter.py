"""Which moments of an exposure each row of an image collects: motion blur and rolling shutter in one."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from math import ceil
from typing import NamedTuple

import numpy as np

from hilbed.types import Array, Image
from hilbed.vision.chip import Light

MOST = 32
"""Images at most for one exposure."""
_STILL = 0.25  # pixels
_FINE = 3  # images a pixel where a row sees few of them
_INSTANT = 1e-9  # s, the resolution of time


class Shutter(NamedTuple):
    """How long a row collects light (s), and by how much the last row is later than the first (s).

    A frame's time is the middle of the exposure of its middle row.
    """

    exposure: float = 0.0
    readout: float = 0.0

    @property
    def span(self) -> float:
        """From the first light on the first row to the last on the last one, s."""
        return self.exposure + self.readout

    @property
    def fineness(self) -> int:
        """How many times closer than for an even blur the images of an exposure have to be."""
        return _FINE if self.readout > self.exposure else 1


def count(motion: float) -> int:
    """Returns how many images make an exposure in which the scene moves by `motion` (pixels).

    They are less than a pixel apart, so that edges become ramps; a quarter of a pixel needs no second one.
    """
    return 1 if motion < _STILL else int(min(MOST, max(2, ceil(motion + 0.5))))


def moments(shutter: Shutter, images: int) -> Array:
    """Returns (images,) the times (s, from the frame's) in the middles of equal parts of the span."""
    return shutter.span * ((np.arange(images) + 0.5) / images - 0.5)


@lru_cache(maxsize=MOST)
def shares(shutter: Shutter, images: int, rows: int) -> Array:
    """Returns (images, rows): the part that each image has in each row, a sum of 1 for every row.

    A row's exposure overlaps the parts of the span that the images stand for; without exposure time it is
    the image nearest in time.
    """
    late = shutter.readout * ((np.arange(rows) + 0.5) / rows - 0.5)
    times = moments(shutter, images)[:, None]
    if shutter.exposure < _INSTANT:
        return np.asarray(np.argmin(np.abs(times - late), 0) == np.arange(images)[:, None], float)
    half = 0.5 * shutter.span / images
    begin = np.maximum(times - half, late - 0.5 * shutter.exposure)
    end = np.minimum(times + half, late + 0.5 * shutter.exposure)
    part = np.maximum(end - begin, 0.0)
    return np.asarray(part / part.sum(0))


def collect(images: Sequence[Image], part: Array, rows: slice) -> Light:
    """Returns the light (h, W, 3) on some rows; part (images, H): what each image has in each row."""
    if len(images) == 1:
        return images[0][rows].astype(np.float32)
    light = np.zeros(images[0][rows].shape, np.float32)
    for image, share in zip(images, part[:, rows].astype(np.float32), strict=True):
        if share.any():
            light += image[rows] * share[:, None, None]
    return light
