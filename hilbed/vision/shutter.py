"""Which moments of an exposure each row of an image collects: motion blur and rolling shutter in one."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from hilbed.types import Array

MOST = 32
"""Images at most for one exposure."""


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


def count(motion: float) -> int:
    """Returns how many images make an exposure in which the scene moves by `motion` (pixels).

    One a pixel and one besides, so that edges are ramps and not stairs; one alone where nothing moves.
    """
    return 1 if motion < 1e-3 else int(min(MOST, 2 + motion))


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
    if not shutter.exposure:
        return np.asarray(np.argmin(np.abs(times - late), 0) == np.arange(images)[:, None], float)
    half = 0.5 * shutter.span / images
    begin = np.maximum(times - half, late - 0.5 * shutter.exposure)
    end = np.minimum(times + half, late + 0.5 * shutter.exposure)
    part = np.maximum(end - begin, 0.0)
    return np.asarray(part / part.sum(0))
