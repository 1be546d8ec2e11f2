"""Stretches of one colour in the rows of an image, and which of them belong together."""

from __future__ import annotations

from typing import Any, NamedTuple, TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from hilbed.types import Image
from hilbed.vision.colour import BACKGROUND, OTHER, Palette

Indices = npt.NDArray[np.intp]
Begins: TypeAlias = npt.NDArray[np.bool_]
"""(H W + 1,), row by row: whether a pixel differs from the one before it; True for the first of a row."""

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


class Blobs(NamedTuple):
    """Runs that follow each other and belong together: each blob's first run and number of runs, (m,)."""

    first: Indices
    size: Indices


def find_runs(image: Image, palette: Palette) -> tuple[Runs, Begins]:
    """Returns the runs of the palette's colours in an (H, W, 3) RGB image, and where its pixels differ.

    A stretch that the border of the image or another colour cuts off is not a run: its edge is not the edge
    of the beacon.
    """
    width = image.shape[1]
    begins, begin, pixel = _stretches(image)
    label = palette.label(pixel)
    changes = np.empty(label.size, np.bool_)
    changes[0] = True
    np.not_equal(label[1:], label[:-1], out=changes[1:])
    change = changes.nonzero()[0]
    label, begin = label[change], begin[change]
    row = begin // width
    column = begin - row * width
    # A change at column 0 is one between two rows and opens nothing.
    ground, coloured = label == BACKGROUND, (label != OTHER) & (column > 0)
    k = (ground[:-2] & coloured[1:-1] & ground[2:] & (row[1:-1] == row[2:])).nonzero()[0] + 1
    return Runs(row[k], column[k] - 1, column[k + 1] - 1, label[k].astype(np.intp)), begins


def _stretches(image: Image) -> tuple[Begins, Indices, Image]:
    """Returns where pixels differ, where stretches of equal pixels begin, (n,), and their pixels (1, n, 4).

    Each row begins a stretch. Only one pixel of each needs to be judged by its colour.
    """
    pixels = cv2.cvtColor(image, cv2.COLOR_RGB2RGBA).view(np.uint32).ravel()
    begins = np.empty(pixels.size + 1, np.bool_)
    np.not_equal(pixels[1:], pixels[:-1], out=begins[1:-1])
    begins[:: image.shape[1]] = True
    begin = begins[:-1].nonzero()[0]
    if begin.size > pixels.size // 2:  # of a noisy image each pixel may as well be judged
        return begins, np.arange(pixels.size), pixels.view(np.uint8).reshape(1, -1, 4)
    return begins, begin, pixels[begin].view(np.uint8).reshape(1, -1, 4)


def gather(runs: Runs) -> tuple[Runs, Blobs]:
    """Returns the runs (n ≥ 1) ordered by blob, and the blobs: one colour, columns that overlap."""
    offset = runs.label * _SPAN
    left = offset + runs.left
    order = left.argsort(kind="stable")
    left, reach = left[order], np.maximum.accumulate((offset + runs.right)[order])
    ends = (left[1:] >= reach[:-1]).nonzero()[0] + 1
    edges = np.array([0, *ends.tolist(), order.size])
    return runs.pick(order), Blobs(edges[:-1], edges[1:] - edges[:-1])
