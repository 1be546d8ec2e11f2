"""A lens that distorts, in front of a renderer that only knows pinholes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import ceil, floor

import cv2
import numpy as np

from hilbed.types import Array, Image, Nanos
from hilbed.vision.distortion import slopes, undistort
from hilbed.vision.lens import Lens
from hilbed.vision.opengl import Pinhole
from hilbed.vision.seams import Renderer, Viewpoint

Pair = tuple[float, float]
Look = tuple[Viewpoint, Nanos]

_MARGIN = 2  # pixels around what is looked up, for the interpolation
_FINEST = 2.0


class Bare:
    """The pinhole that is rendered for a lens; like a Lens, but as large as it takes."""

    def __init__(self, size: tuple[int, int], focal: Pair, centre: Pair) -> None:
        self.width, self.height = size
        self.fx, self.fy = focal
        self.cx, self.cy = centre


class Warped:
    """Renders what a distorting lens shows.

    The pinhole's image is interpolated between its pixels, since edges would be rounded to whole pixels twice
    otherwise; its labels are taken from the nearest one. `make` returns the renderer of a pinhole.
    """

    def __init__(self, lens: Lens, make: Callable[[Pinhole], Renderer]) -> None:
        x, y = _looked_up(lens)
        source = _source(lens, x, y)
        column, row = source.cx + source.fx * x, source.cy + source.fy * y
        self._maps = cv2.convertMaps(column.astype(np.float32), row.astype(np.float32), cv2.CV_16SC2)
        self._nearest = (np.rint(row).astype(np.intp), np.rint(column).astype(np.intp))
        self._renderer = make(source)

    def render(self, view: Viewpoint, t: Nanos) -> Image:
        """Returns (H, W, 3) RGB as seen from `view` at t."""
        return self.mean([(view, t)])

    def mean(self, looks: Sequence[Look]) -> Image:
        """Returns the mean (H, W, 3) of images, with one distortion for all of them."""
        image = mean(self._renderer, looks)
        return np.asarray(cv2.remap(image, *self._maps, cv2.INTER_LINEAR), np.uint8)

    def labels(self, view: Viewpoint, t: Nanos) -> Image:
        """Returns (H, W) of what each pixel shows: 0 nothing of interest, k + 1 the beacon of index k."""
        return self._renderer.labels(view, t)[self._nearest]

    def close(self) -> None:
        """Gives back what the pinhole's renderer holds."""
        self._renderer.close()


def mean(renderer: Renderer, looks: Sequence[Look]) -> Image:
    """Returns the mean (H, W, 3) of the images seen from viewpoints at times."""
    if isinstance(renderer, Warped):
        return renderer.mean(looks)
    images = [renderer.render(*look) for look in looks]
    if len(images) == 1:
        return images[0]
    total = cv2.add(images[0], images[1], dtype=cv2.CV_16U)
    for image in images[2:]:
        total = cv2.add(total, image, dtype=cv2.CV_16U)
    return np.asarray(cv2.convertScaleAbs(total, alpha=1.0 / len(images)), np.uint8)


def _looked_up(lens: Lens) -> tuple[Array, Array]:
    """Returns where each pixel (H, W) lies in the pinhole's image, in units of the focal length."""
    column, row = np.meshgrid(np.arange(lens.width, dtype=float), np.arange(lens.height, dtype=float))
    return undistort((column - lens.cx) / lens.fx, (row - lens.cy) / lens.fy, lens.coefficients)


def _source(lens: Lens, x: Array, y: Array) -> Bare:
    """Returns a pinhole that shows all that is looked up, where the lens magnifies most as fine as it."""
    xx, yy, _ = slopes(x, y, lens.coefficients)
    fx = lens.fx * min(_FINEST, max(1.0, float(xx.max())))
    fy = lens.fy * min(_FINEST, max(1.0, float(yy.max())))
    left, right = floor(fx * x.min()) - _MARGIN, ceil(fx * x.max()) + _MARGIN
    top, bottom = floor(fy * y.min()) - _MARGIN, ceil(fy * y.max()) + _MARGIN
    size = (right - left + 1, bottom - top + 1)
    return Bare(size, (fx, fy), (float(-left), float(-top)))
