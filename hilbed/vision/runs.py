"""Stretches of one colour in the rows of an image, and which of them belong together."""

from __future__ import annotations

from typing import Any, NamedTuple

import cv2
import numpy as np
import numpy.typing as npt

from hilbed.types import Image
from hilbed.vision.colour import BACKGROUND, OTHER, Palette

Indices = npt.NDArray[np.intp]

_SPAN = 1 << 20  # more than an image has columns


class Runs(NamedTuple):
    """Stretches that show both edges: the background lies on both sides.

    All (n,): row, label, and the columns of the last pixel before (left) and of the last one inside (right).
    """

    row: Indices
    left: Indices
    right: Indices
    label: Indices

    def pick(self, which: npt.NDArray[Any]) -> Runs:
        """Returns the runs that an index array or a mask selects."""
        return Runs(self.row[which], self.left[which], self.right[which], self.label[which])


def find_runs(image: Image, palette: Palette) -> Runs:
    """Returns the runs of the palette's colours in an (H, W, 3) RGB image, row by row.

    A stretch that the border of the image or another colour cuts off is not a run: its edge is not the edge
    of the beacon.
    """
    width = image.shape[1]
    begin, pixel = _stretches(image)
    label = palette.label(pixel)
    change = (label[1:] != label[:-1]).nonzero()[0]
    outside, inside, begin = label[change], label[change + 1], begin[change + 1]
    row = begin // width
    column = begin - row * width
    # A change at column 0 is one between two rows and opens nothing.
    opens = (outside[:-1] == BACKGROUND) & (inside[:-1] != OTHER) & (column[:-1] > 0)
    k = (opens & (inside[1:] == BACKGROUND) & (row[1:] == row[:-1])).nonzero()[0]
    return Runs(row[k], column[k] - 1, column[k + 1] - 1, inside[k].astype(np.intp))


def _stretches(image: Image) -> tuple[Indices, Image]:
    """Returns where each stretch of equal pixels begins, (n,) counted row by row, and its pixel (1, n, 4).

    Each row begins a stretch. Only one pixel of each needs to be judged by its colour.
    """
    pixels = cv2.cvtColor(image, cv2.COLOR_RGB2RGBA).view(np.uint32).ravel()
    begins = np.empty(pixels.size, np.bool_)
    np.not_equal(pixels[1:], pixels[:-1], out=begins[1:])
    begins[:: image.shape[1]] = True
    if np.count_nonzero(begins) > pixels.size // 2:  # of a noisy image each pixel may as well be judged
        return np.arange(pixels.size), pixels.view(np.uint8).reshape(1, -1, 4)
    begin = begins.nonzero()[0]
    return begin, pixels[begin].view(np.uint8).reshape(1, -1, 4)


def gather(runs: Runs) -> tuple[Runs, Indices]:
    """Returns the runs ordered by blob and the blob (n,) of each: one colour, columns that overlap."""
    offset = runs.label * _SPAN
    left = offset + runs.left
    order = left.argsort(kind="stable")
    left, reach = left[order], np.maximum.accumulate((offset + runs.right)[order])
    blob = np.zeros(order.size, np.intp)
    np.cumsum(left[1:] >= reach[:-1], out=blob[1:])
    return runs.pick(order), blob


def bounds(blob: Indices) -> tuple[Indices, Indices]:
    """Returns each blob's first run and number of runs, both (m,), from the blob (n,) of each run, n ≥ 1."""
    edges = np.concatenate(([0], (blob[1:] != blob[:-1]).nonzero()[0] + 1, [blob.size]))
    return edges[:-1], edges[1:] - edges[:-1]
