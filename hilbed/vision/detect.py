"""Finds beacons by colour and measures the azimuths of their axes to a fraction of a pixel."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hilbed.scene import BeaconSpec
from hilbed.types import Array
from hilbed.vision.colour import Palette
from hilbed.vision.edges import crisp, is_soft, soft
from hilbed.vision.fits import Fit, fit
from hilbed.vision.lens import Lens
from hilbed.vision.rays import steepness
from hilbed.vision.runs import Blobs, Indices, Runs, find_runs, gather
from hilbed.vision.seams import Detection, Shot

FEWEST_ROWS = 3
ROUGH = 0.4  # pixels: edges rounded to whole pixels lie 1/√12 (rms) off a straight line, hardly ever more


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
        runs, begins = find_runs(shot.image, self._palette)
        if runs.row.size == 0:
            return []
        runs, blobs = gather(runs)
        blurred = is_soft(shot.image, runs, begins)
        runs, blobs = self._trim(runs, blobs, blurred)
        if runs.row.size == 0:
            return []
        edges = soft(shot.image, runs, blobs) if blurred else crisp(runs)
        may_lean = blobs.first.size > 1 or self._sole[int(runs.label[0]) - 1]
        fits = fit(self._lens, runs, blobs, edges, may_lean)
        found = [self._detection(one) for one in fits if one.rough <= ROUGH]
        return sorted(found, key=lambda detection: detection.column)

    def _trim(self, runs: Runs, blobs: Blobs, blurred: bool) -> tuple[Runs, Blobs]:
        """Leaves out rows that cross the rims of foot and top, and blobs with few rows or two runs in one.

        Where edges are soft, a rim takes a row more, which may show it in two pieces.
        """
        row, (first, size) = runs.row, blobs
        top, bottom = np.minimum.reduceat(row, first), np.maximum.reduceat(row, first)
        radius = 0.5 * np.maximum.reduceat(runs.right - runs.left, first)
        upper, lower = radius * self._steepness(runs, blobs, np.array((top, bottom)))
        highest, lowest = top + upper + blurred, bottom - lower - blurred
        keep = (row >= highest.repeat(size)) & (row <= lowest.repeat(size))
        shown = np.add.reduceat(keep, first, dtype=np.intp)
        seen, rows = (shown, np.floor(lowest) - np.ceil(highest)) if blurred else (size, bottom - top)
        whole = (seen <= rows + 1) & (shown >= FEWEST_ROWS)
        kept = (keep & whole.repeat(size)).nonzero()[0]
        size = shown[whole]
        return runs.pick(kept), Blobs(size.cumsum() - size, size)

    def _steepness(self, runs: Runs, blobs: Blobs, rims: Indices) -> Array:
        """Returns (2, m) how steeply the camera looks at the rims in these rows."""
        if self._lens.upright:
            return steepness(self._lens, 0.0, rims)
        middle = np.add.reduceat(0.5 * (runs.left + runs.right), blobs.first) / blobs.size
        return steepness(self._lens, middle, rims)

    def _detection(self, fit: Fit) -> Detection:
        return Detection(fit.azimuth, fit.std, fit.column, self._identity[fit.label - 1], fit.row)
