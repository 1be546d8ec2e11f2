"""Azimuths of upright axes, from where the edges of blobs are."""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numpy as np

from hilbed.types import Array
from hilbed.vision.edges import Edges
from hilbed.vision.lens import Lens
from hilbed.vision.rays import leans, places, rays
from hilbed.vision.rounding import of_crossings, of_steps
from hilbed.vision.runs import Blobs, Runs

_LEANING = 0.6  # pixels over the tallest beacon's rows, more than rounding makes of any upright axis
_FINEST = 0.004  # pixels: the beacon's shape is not drawn any better
_INTERPOLATED = 0.008  # pixels: OpenCV distorts images with weights of 1/32 pixel
_TALL = 12  # rows: fewer may lean by rounding alone
_STEPPED = 0.025  # pixels: what steps of a third of a pixel add where a rolling shutter is drawn
_ROUNDED = 0.24  # pixels: how far (rms) edges that are rounded to whole pixels lie off a straight line


class Fit(NamedTuple):
    """What is known of one blob.

    azimuth of its axis and standard deviation (rad), column and row of its middle, label, how far its edges
    lie off straight lines (pixels).
    """

    azimuth: float
    std: float
    column: float
    row: float
    label: int
    rough: float


class Axes(NamedTuple):
    """Axes fitted to blobs: all (m,) but for `depth`.

    azimuth: rad; pixel: angle of one there; depression: tangent of its middle's; row: of its middle; taper:
    rad by which half the width grows with the depression; rough: pixels; depth: (n,) by how much the
    depression of each run differs; common: rad a row by which all axes lean.
    """

    azimuth: Array
    pixel: Array
    depression: Array
    row: Array
    taper: Array
    rough: Array
    depth: Array
    common: float


def fit(lens: Lens, runs: Runs, blobs: Blobs, edges: Edges, may_lean: bool) -> list[Fit]:
    """Returns the axis of each blob; may_lean: whether they may all lean, by a rolling shutter."""
    axes = _axes(lens, runs, blobs, edges, may_lean)
    rough, pixel, rows = axes.rough.tolist(), axes.pixel.tolist(), blobs.size.tolist()
    noise, part = _softness(edges, blobs, rough)
    more = _INTERPOLATED**2 if lens.distorted else 0.0
    more_steps = _STEPPED**2 if axes.common and not edges.blurred else 0.0
    off = [max(_FINEST, one) for one in _rounding(lens, runs, blobs, axes, part)]
    std = [
        angle * sqrt(one * one + more + more_steps + 0.5 * n / size)
        for angle, one, n, size in zip(pixel, off, noise, rows, strict=True)
    ]
    column, row = places(lens, axes.azimuth, axes.depression, axes.row)
    label = runs.label[blobs.first].tolist()
    return [*map(Fit, axes.azimuth.tolist(), std, column.tolist(), row.tolist(), label, rough)]


def _softness(edges: Edges, blobs: Blobs, rough: list[float]) -> tuple[list[float], list[float]]:
    """Returns noise of an edge (pixels squared; the mean of two has half of it), part of rounding left."""
    if not edges.blurred:
        return [0.0] * len(rough), [1.0] * len(rough)
    noise = (np.add.reduceat(edges.noise**2, blobs.first) / blobs.size).tolist()
    return noise, [min(1.0, sqrt(max(r * r - n, 0.0)) / _ROUNDED) for r, n in zip(rough, noise, strict=True)]


def _axes(lens: Lens, runs: Runs, blobs: Blobs, edges: Edges, may_lean: bool) -> Axes:
    """Fits an axis to each blob.

    The edges of a cone obey azimuth = axis ± (a + b tan(depression)). In one row, left and right edge
    differ in depression where the beacon is off the middle of the image; b takes that out.
    """
    first, size = blobs

    def mean(x: Array) -> Array:
        return np.asarray(np.add.reduceat(x, first, axis=-1) / size)

    def each(x: Array) -> Array:
        return x.repeat(size, axis=-1)

    left, right, low, high = rays(lens, edges.columns, runs.row)
    spread = np.array((0.5 * (left - right), 0.5 * (low + high), runs.row), float)
    means = mean(spread)
    (width, depression, row), (half, depth, height) = means, spread - each(means)
    narrowing, deep, tall = mean(np.array((depth * half, depth * depth, height * height)))
    taper = narrowing / deep
    tapers = each(taper)
    middle = 0.5 * (left + right) - 0.5 * tapers * (low - high)
    azimuth = mean(middle)
    if lens.plain:
        pixel = np.cos(azimuth) ** 2 / lens.fx
    else:
        pixel = 2.0 * width / mean(edges.columns[1] - edges.columns[0])

    middle -= each(azimuth)
    half -= tapers * depth
    leaning, off = mean(np.array((middle * height, middle * middle + half * half)))
    common = _common((leaning / tall).tolist(), pixel.tolist(), size.tolist()) if may_lean else 0.0
    if common:
        middle -= common * height
        azimuth += common * (lens.cy - row)
        off = mean(middle * middle + half * half)
    return Axes(azimuth, pixel, depression, row, taper, np.sqrt(off) / pixel, depth, common)


def _common(leaning: list[float], pixel: list[float], rows: list[int]) -> float:
    """Returns by how much (rad a row) all axes lean, as a rolling shutter makes them; 0 where they stand.

    leaning: that of each; pixel: rad. It is the median, in which each counts as much as its lean is certain:
    as the cube of its rows.
    """
    if max(rows) < _TALL:
        return 0.0
    lean, weight, half = 0.0, 0, 0.5 * sum(n**3 for n in rows)
    for one, n in sorted(zip(leaning, rows, strict=True)):
        if weight < half:
            lean, weight = one, weight + n**3
    most = max(abs(lean) * n / angle for n, angle in zip(rows, pixel, strict=True))
    return lean if most > _LEANING else 0.0


def _rounding(lens: Lens, runs: Runs, blobs: Blobs, axes: Axes, part: list[float]) -> list[float]:
    """Returns the error (pixels) of each blob's azimuth from rounding; part: of it that is left."""
    first, size = blobs
    if lens.upright and not axes.common:
        steps = np.maximum.reduceat(runs.left, first) - np.minimum.reduceat(runs.left, first)
        return [*map(of_steps, steps.tolist(), part)]
    top, bottom = np.minimum.reduceat(axes.depth, first), np.maximum.reduceat(axes.depth, first)
    lean = leans(lens, axes.azimuth, axes.depression + top, axes.depression + bottom)
    lean += axes.common / axes.pixel * (size - 1)
    narrows = axes.taper * (bottom - top) / axes.pixel
    whole = size / (size - 1.0)  # half a row more at either end
    left, right = np.abs((lean - narrows) * whole), np.abs((lean + narrows) * whole)
    return [*map(of_crossings, left.tolist(), right.tolist(), size.tolist(), part)]
