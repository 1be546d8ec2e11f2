"""Where exactly the edges of runs are, in images whose edges are soft: blurred, noisy or interpolated."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from hilbed.types import Array, Image
from hilbed.vision.runs import Begins, Blobs, Indices, Runs

# Pixels a run that differ from their neighbour beside an edge: at least 2 where edges are soft, 4 at most; in
# a sharp image 0, but for beacons that stand side by side, texture, shading and noise.
_UNEVEN = 1.5
_SOFT = 0.6  # edges a run beside which a pixel has a mixed colour: 1 to 2 where edges are soft
_MIXED = (0.25, 0.75)  # part of the change from the background's colour to the beacon's
_SAMPLE = 64  # runs that are enough to judge by
_SOLID = 3  # pixels: narrower runs may be noise
_REACHES = (3, 6, 12)  # pixels on either side of where the colour is first seen
_LEVEL = 0.02  # of a full change a pixel: the background
_STEEP = (
    0.34  # of a full change a pixel: then it is all within four pixels, and its place is exactly their sum
)
_FEW = 0.25  # of the squared difference of two colours
_WIDE = 4  # pixels: the middle of a run that wide has the beacon's colour


class Edges(NamedTuple):
    """Columns (2, n) of left and right edge of each run, and standard deviation (n,) from noise (pixels).

    blurred: whether they may be found more finely than to whole pixels.
    """

    columns: Array
    noise: Array
    blurred: bool


def crisp(runs: Runs) -> Edges:
    """Returns edges halfway between the last pixel outside and the first one inside."""
    columns = np.array((runs.left, runs.right), float) + 0.5
    return Edges(columns, np.zeros(runs.row.size), False)


def is_soft(image: Image, runs: Runs, begins: Begins) -> bool:
    """Tells whether many edges show pixels of a colour between the background's and the beacon's.

    Texture, shading and noise make pixels differ, too, but leave edges as sharp as they are.
    """
    runs = Runs(*(column[:: 1 + runs.row.size // _SAMPLE] for column in runs))
    if _changes(runs, begins, image.shape[1]) <= _UNEVEN * runs.row.size:
        return False
    sides = _beside(runs, image.shape[1] - 1)
    pixels = image[runs.row, sides]
    red, green, blue = np.moveaxis(pixels[:, ::2] != pixels[:, 1::2], -1, 0)
    if np.count_nonzero(red | green | blue) <= _UNEVEN * runs.row.size:
        return False
    solid = runs.right - runs.left >= _SOLID
    pixels = pixels[:, :, solid] if solid.any() else pixels
    return bool(_mixed(pixels.astype(np.float32)) > _SOFT * pixels.shape[2])


def _changes(runs: Runs, begins: Begins, width: int) -> int:
    """Returns how many pixels beside edges differ from their neighbour, or are at a border."""
    start = runs.row * width
    left, right = start + runs.left, start + runs.right
    return int(np.count_nonzero(begins[np.concatenate((left, left + 2, right, right + 2))]))


def _beside(runs: Runs, last: int) -> Indices:
    """Returns (2, 4, n) the columns of four pixels across either edge, from the background inwards."""
    left, right = runs.left, runs.right
    inside, outside = left + 1, right + 1
    return np.array(
        [
            (np.maximum(left - 1, 0), left, inside, np.minimum(left + 2, right)),
            (np.minimum(right + 2, last), outside, right, np.maximum(right - 1, inside)),
        ]
    )


def _mixed(pixels: Array) -> int:
    """Returns how many edges across four pixels (2, 4, n, 3) show a mixed colour at one of the inner two."""
    change = pixels - pixels[:, :1]
    full = change[:, 3]
    size = np.maximum(np.einsum("snc,snc->sn", full, full), 1.0)
    part = np.einsum("sknc,snc->skn", change[:, 1:3], full) / size[:, None]
    mixed = (part > _MIXED[0]) & (part < _MIXED[1])
    return int(np.count_nonzero(mixed[:, 0] | mixed[:, 1]))


def soft(image: Image, runs: Runs, blobs: Blobs) -> Edges:
    """Returns edges where the colour has changed by half from the background's to the beacon's.

    A steep edge is placed by how much of four pixels it covers, which is exact for edges interpolated
    between pixels, where the line through two pixels is up to 0.09 pixel off.
    image: (H, W, 3).
    """
    full = np.tile(_full_colour(image, runs, blobs), (2, 1))
    height, width, colours = image.shape
    pixels = image.reshape(height * width, colours)
    begin, inside = np.tile(runs.row * width, 2), np.concatenate((runs.left + 1, runs.right))
    outwards = np.repeat((-1, 1), runs.row.size)
    for reach in _REACHES:
        column = inside[:, None] + outwards[:, None] * np.arange(-reach, reach + 1)
        near = pixels.take(begin[:, None] + np.clip(column, 0, width - 1), 0)
        cover = _cover(near.astype(float), full)
        if np.mean(cover[:, -2] - cover[:, -1]) < _LEVEL:
            break
    beyond, noise = _crossing(cover)
    columns, (low, high) = (inside + outwards * beyond).reshape(2, -1), noise.reshape(2, -1)
    return Edges(columns, np.hypot(low, high) / np.sqrt(2.0), True)


def _full_colour(image: Image, runs: Runs, blobs: Blobs) -> Array:
    """Returns (n, 3) the colour in the middle of the beacon that each run belongs to."""
    first, count = blobs
    width = runs.right - runs.left
    widest = np.repeat(np.maximum.reduceat(width, first), count)
    weight = (width >= np.minimum(widest, _WIDE)).astype(float)
    middle = image[runs.row, (runs.left + runs.right + 1) // 2] * weight[:, None]
    total = np.add.reduceat(middle, first) / np.add.reduceat(weight, first)[:, None]
    return np.asarray(np.repeat(total, count, 0))


def _cover(pixels: Array, full: Array) -> Array:
    """Returns (n, k) the part of the full colour (n, 3) in pixels (n, k, 3), the last two background.

    It is 1 less the part of the background, seen in what no shade of the full colour can show: edges of a
    beacon that is lit from one side are darker than its middle. Where that is little, all differences count.
    """
    outside = 0.5 * (pixels[:, -1] + pixels[:, -2])
    away = outside - full
    axis = outside - (_dot(outside, full) / np.maximum(_dot(full, full), 1.0))[:, None] * full
    little = _dot(axis, axis) < _FEW * _dot(away, away)
    axis[little] = away[little]
    axis /= np.maximum(_dot(away, axis), 1.0)[:, None]
    part = np.matmul(pixels, axis[:, :, None])[:, :, 0]
    return np.asarray(1.0 + _dot(full, axis)[:, None] - part)


def _dot(a: Array, b: Array) -> Array:
    return np.asarray(np.einsum("nc,nc->n", a, b))


def _crossing(cover: Array) -> tuple[Array, Array]:
    """Returns how far outside the middle pixel of (n, k) the edge lies, and its std from noise."""
    rows, last = np.arange(cover.shape[0]), cover.shape[1] - 1
    falls = (cover[:, :-1] >= 0.5) & (cover[:, 1:] < 0.5)
    k = np.where(falls, np.abs(np.arange(last) - last // 2), last).argmin(1)
    found = falls[rows, k]
    k = np.where(found, k, last // 2)
    here, there = cover[rows, k], cover[rows, k + 1]
    slope = np.where(found, here - there, 1.0)
    part = np.where(found, (here - 0.5) / slope, 0.5)
    noise = np.sqrt(0.5 * np.mean((cover[:, -1] - cover[:, -2]) ** 2))

    steep = (slope > _STEEP) & (k > 0) & (k < last - 1)
    first, flat = rows * (last + 1) + np.clip(k, 1, last - 2) - 1, cover.ravel()
    area = flat[first] + flat[first + 1] + flat[first + 2] + flat[first + 3]
    std = np.where(steep, 2.0, np.hypot(part, 1.0 - part) / slope)
    return k - last // 2 + np.where(steep, area - 1.5, part), noise * std
