"""Finds beacons by colour and measures the azimuths of their axes to a fraction of a pixel."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from hilbed.scene import BeaconSpec
from hilbed.types import Array
from hilbed.vision.colour import Palette
from hilbed.vision.edges import Edges, crisp, is_soft, soft
from hilbed.vision.lens import Lens
from hilbed.vision.rays import leans, pixel_angle, places, rays, steepness
from hilbed.vision.runs import Indices, Runs, bounds, find_runs, gather
from hilbed.vision.seams import Detection, Shot

FEWEST_ROWS = 3
ROUGH = 0.4  # pixels: edges rounded to whole pixels lie 1/√12 (rms) off a straight line, hardly ever more

# Error of an azimuth in pixels, measured on rendered cones from 1 to 9 m: rounding averages out the better
# the more pixel columns an edge crosses. An edge that crosses none is off by 1/√12, two of them by 1/√24.
_ROUNDING = 0.066
_UPRIGHT = 0.2
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


class ColourDetector:
    """Takes each run of a beacon's colour that shows both edges, and averages the edges' angles.

    A beacon that is partly hidden is measured on the rows that show it whole, or not at all. Two of one
    colour that cover each other are left out, as their edges are not straight; unseen remains an error of at
    most half a pixel where they are nearly in line. Identity is the index of the one beacon that has the
    colour; None where several share it, or if `anonymous`.
    """

    def __init__(self, lens: Lens, beacons: Sequence[BeaconSpec], anonymous: bool = False) -> None:
        self._lens = lens
        colours: list[str] = [beacon.colour for beacon in beacons]
        self._palette = Palette(colours)
        self._sole = [colours.count(colour) == 1 for colour in self._palette.colours]
        self._identity = [
            colours.index(colour) if sole and not anonymous else None
            for colour, sole in zip(self._palette.colours, self._sole, strict=True)
        ]

    def detect(self, shot: Shot) -> list[Detection]:
        """Returns what is seen, from left to right."""
        runs = find_runs(shot.image, self._palette)
        if runs.row.size == 0:
            return []
        runs, blob = gather(runs)
        blurred = is_soft(shot.image, runs)
        runs, blob = self._trim(runs, blob, blurred)
        if runs.row.size == 0:
            return []
        edges = soft(shot.image, runs, blob) if blurred else crisp(runs)
        found = [self._detection(fit) for fit in self._measure(runs, blob, edges) if fit.rough <= ROUGH]
        return sorted(found, key=lambda detection: detection.column)

    def _trim(self, runs: Runs, blob: Indices, blurred: bool) -> tuple[Runs, Indices]:
        """Leaves out rows that cross the rims of foot and top, and blobs with few rows or two runs in one.

        Where edges are soft, a rim takes a row more, which may show it in two pieces.
        """
        row = runs.row
        first, count = bounds(blob)
        top, bottom = np.minimum.reduceat(row, first), np.maximum.reduceat(row, first)
        radius = 0.5 * np.maximum.reduceat(runs.right - runs.left, first)
        middle = np.add.reduceat(0.5 * (runs.left + runs.right), first) / count
        rims = np.concatenate((top, bottom))
        steep = steepness(self._lens, np.concatenate((middle, middle)), rims)
        upper, lower = radius * steep.reshape(2, -1)
        highest, lowest = top + upper + blurred, bottom - lower - blurred
        keep = (row >= highest[blob]) & (row <= lowest[blob])
        rows = np.floor(lowest) - np.ceil(highest) if blurred else bottom - top
        many = (np.add.reduceat(keep, first, dtype=np.intp) if blurred else count) > rows + 1
        keep &= ~many[blob]
        keep &= np.add.reduceat(keep, first, dtype=np.intp)[blob] >= FEWEST_ROWS
        kept = keep.nonzero()[0]
        return runs.pick(kept), blob[kept]

    def _measure(self, runs: Runs, blob: Indices, edges: Edges) -> Iterator[Fit]:
        """Yields the azimuth of each blob's axis.

        The edges of a cone obey azimuth = axis ± (a + b tan(depression)). In one row, left and right edge
        differ in depression where the beacon is off the middle of the image; b takes that out.
        """
        first, count = bounds(blob)
        blob = np.repeat(np.arange(first.size), count)

        def mean(x: Array) -> Array:
            return np.asarray(np.add.reduceat(x, first) / count)

        left, right, low, high = rays(self._lens, edges, runs.row)
        middle, half, depth = 0.5 * (left + right), 0.5 * (left - right), 0.5 * (low + high)
        width, depression = mean(half), mean(depth)
        depth -= depression[blob]
        half -= width[blob]
        taper = (mean(depth * half) / mean(depth * depth))[blob]
        middle -= 0.5 * taper * (low - high)
        azimuth = mean(middle)

        pixel = pixel_angle(self._lens, azimuth, mean(edges.right - edges.left), 2.0 * width)
        middle -= azimuth[blob]
        half -= taper * depth
        row = mean(runs.row.astype(float))
        height = runs.row - row[blob]
        leaning = mean(middle * height) / mean(height * height)
        alone = count.size == 1 and not self._sole[int(runs.label[0]) - 1]
        common = 0.0 if alone else _common(leaning, pixel, count)
        if common:
            middle -= common * height
            azimuth += common * (self._lens.cy - row)
        rough = np.sqrt(mean(middle * middle + half * half)) / pixel
        noise, part = np.zeros_like(rough), np.ones_like(rough)
        if edges.blurred:
            noise = mean(edges.noise**2)  # of an edge, pixels squared; the mean of two has half of it
            part = np.minimum(1.0, np.sqrt(np.maximum(rough**2 - noise, 0.0)) / _ROUNDED)
        if self._lens.upright and not common:
            rounding = _of_steps(runs.left, first, part)
        else:
            top, bottom = np.minimum.reduceat(depth, first), np.maximum.reduceat(depth, first)
            lean = leans(self._lens, azimuth, depression + top, depression + bottom)
            lean += common / pixel * (count - 1)
            narrows = taper[first] * (bottom - top) / pixel
            whole = count / (count - 1.0)  # half a row more at either end
            crossed = np.abs((lean - narrows) * whole), np.abs((lean + narrows) * whole)
            rounding = _of_crossings(*crossed, count, part)
        drawn = np.maximum(rounding, _FINEST) ** 2 + (_INTERPOLATED**2 if self._lens.distorted else 0.0)
        drawn += _STEPPED**2 if common and not edges.blurred else 0.0
        std = pixel * np.sqrt(drawn + 0.5 * noise / count)
        column, row = places(self._lens, azimuth, depression, row)
        columns = (azimuth, std, column, row, runs.label[first], rough)
        return map(Fit, *(one.tolist() for one in columns))

    def _detection(self, fit: Fit) -> Detection:
        return Detection(fit.azimuth, fit.std, fit.column, self._identity[fit.label - 1], fit.row)


def _common(leaning: Array, pixel: Array, rows: Indices) -> float:
    """Returns by how much (rad a row) all axes lean, as a rolling shutter makes them; 0 where they stand.

    leaning: that of each; pixel: rad. It is the median, in which each counts as much as its lean is certain:
    as the cube of its rows.
    """
    order = np.argsort(leaning)
    weight = np.cumsum(rows[order].astype(float) ** 3)
    lean = float(leaning[order[np.searchsorted(weight, 0.5 * weight[-1])]])
    certain = rows.max() >= _TALL and (abs(lean) * rows / pixel).max() > _LEANING
    return lean if certain else 0.0


def _of_steps(column: Indices, first: Indices, part: Array) -> Array:
    """Returns the error (pixels) of each blob's azimuth from rounded edges that cross as many columns.

    part: of the rounding that is left where edges are soft, as they show where they cross columns.
    """
    steps = np.maximum.reduceat(column, first) - np.minimum.reduceat(column, first)
    return np.where(steps > 0, _ROUNDING / (1 + steps) * part, _UPRIGHT)


def _of_crossings(left: Array, right: Array, rows: Indices, part: Array) -> Array:
    """Returns the same for edges that cross these numbers of columns in so many rows.

    The mean of a sawtooth of ±1/2 over x ≥ 1 of its periods has a variance of f² (1 − f)² / (12 x²), f being
    the part of the last period: 1 / (360 x²) for any f. Within the first period it is (1 − x)² / 12. Taken
    on n rows, each of the x jumps is found to x / n of a period, which adds x / (12 n²).
    """

    def one(x: Array) -> Array:
        first = np.maximum(1.0 - x, 0.0) ** 2 / 12.0
        later = part * part / 360.0 / np.maximum(x, 1.0) ** 2
        return np.asarray(np.maximum(first, later) + part * part * x / (12.0 * rows * rows))

    both: Array = np.sqrt(one(left) + one(right))
    return 0.5 * both
