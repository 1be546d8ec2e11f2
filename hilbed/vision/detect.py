"""Finds beacons by colour and measures the azimuths of their axes to a fraction of a pixel."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hilbed.scene import BeaconSpec
from hilbed.types import Array
from hilbed.vision.colour import Palette
from hilbed.vision.lens import Lens
from hilbed.vision.runs import Indices, Runs, bounds, find_runs, gather
from hilbed.vision.seams import Detection, Shot

FEWEST_ROWS = 3
ROUGH = 0.4  # pixels: edges rounded to whole pixels lie 1/√12 (rms) off a straight line, hardly ever more

# Error of an azimuth in pixels, measured on rendered cones from 1 to 9 m: rounding averages out the better
# the more pixel columns an edge crosses. An edge that crosses none is off by 1/√12, two of them by 1/√24.
_ROUNDING = 0.066
_UPRIGHT = 0.2
_FINEST = 0.004  # pixels: the beacon's shape is not drawn any better


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
        self._identity = [
            None if anonymous or colours.count(colour) > 1 else colours.index(colour)
            for colour in self._palette.colours
        ]
        edges = np.arange(lens.width - 1) + 0.5
        self._angle = np.arctan((lens.cx - edges) / lens.fx)
        self._cos = np.cos(self._angle)
        self._drop = (np.arange(lens.height) - lens.cy) / lens.fx
        self._slope = np.abs(self._drop)
        self._focal = lens.fx

    def detect(self, shot: Shot) -> list[Detection]:
        """Returns what is seen, from left to right."""
        runs = find_runs(shot.image, self._palette)
        if runs.row.size == 0:
            return []
        runs, blob = self._trim(*gather(runs))
        if runs.row.size == 0:
            return []
        return sorted(self._measure(runs, blob), key=lambda detection: detection.column)

    def _trim(self, runs: Runs, blob: Indices) -> tuple[Runs, Indices]:
        """Leaves out rows that cross the rims of foot and top, and blobs with few rows or two runs in one."""
        row = runs.row
        first, count = bounds(blob)
        top, bottom = np.minimum.reduceat(row, first), np.maximum.reduceat(row, first)
        radius = 0.5 * np.maximum.reduceat(runs.right - runs.left, first)
        highest, lowest = top + radius * self._slope[top], bottom - radius * self._slope[bottom]
        highest[count > bottom - top + 1] = np.inf
        keep = (row >= highest[blob]) & (row <= lowest[blob])
        keep &= np.add.reduceat(keep, first, dtype=np.intp)[blob] >= FEWEST_ROWS
        return runs.pick(keep), blob[keep]

    def _measure(self, runs: Runs, blob: Indices) -> list[Detection]:
        """Returns the azimuth of each blob's axis.

        The edges of a cone obey azimuth = axis ± (a + b tan(depression)). In one row, left and right edge
        differ in depression where the beacon is off the middle of the image; b takes that out.
        """
        first, count = bounds(blob)
        blob = np.repeat(np.arange(first.size), count)

        def mean(x: Array) -> Array:
            return np.asarray(np.add.reduceat(x, first) / count)

        left, right, drop = self._angle[runs.left], self._angle[runs.right], self._drop[runs.row]
        low, high = drop * self._cos[runs.left], drop * self._cos[runs.right]
        middle, half, depth = 0.5 * (left + right), 0.5 * (left - right), 0.5 * (low + high)
        depth -= mean(depth)[blob]
        half -= mean(half)[blob]
        taper = (mean(depth * half) / mean(depth * depth))[blob]
        middle -= 0.5 * taper * (low - high)
        azimuth = mean(middle)

        pixel = np.cos(azimuth) ** 2 / self._focal
        middle -= azimuth[blob]
        half -= taper * depth
        rough = np.sqrt(mean(middle * middle + half * half)) / pixel
        steps = np.maximum.reduceat(runs.left, first) - np.minimum.reduceat(runs.left, first)
        rounding = np.where(steps > 0, _ROUNDING / (1 + steps), _UPRIGHT)
        std = pixel * np.maximum(rounding, _FINEST)
        found = zip(azimuth.tolist(), std.tolist(), runs.label[first].tolist(), rough.tolist(), strict=True)
        return [self._detection(*one) for *one, off in found if off <= ROUGH]

    def _detection(self, azimuth: float, std: float, label: int) -> Detection:
        return Detection(azimuth, std, self._lens.column(azimuth), self._identity[label - 1])
