"""Stretches of one colour in the rows of a label image, and which of them belong together."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from hilbed.vision.colour import BACKGROUND, OTHER, Labels

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


def find_runs(labels: Labels) -> Runs:
    """Returns the runs of all colours in an (H, W) label image, row by row.

    A stretch that the border of the image or another colour cuts off is not a run: its edge is not the edge
    of the beacon.
    """
    change = np.flatnonzero(labels[:, 1:] != labels[:, :-1])
    row, before = np.divmod(change, labels.shape[1] - 1)
    outside, inside = labels[row, before], labels[row, before + 1]
    opens = (outside[:-1] == BACKGROUND) & (inside[:-1] != OTHER)
    closes = (inside[1:] == BACKGROUND) & (row[1:] == row[:-1])
    k = np.flatnonzero(opens & closes)
    return Runs(row[k], before[k], before[k + 1], inside[k].astype(np.intp))


def gather(runs: Runs) -> tuple[Runs, Indices]:
    """Returns the runs ordered by blob and the blob (n,) of each: one colour, columns that overlap."""
    offset = runs.label * _SPAN
    order = np.argsort(offset + runs.left, kind="stable")
    runs, offset = runs.pick(order), offset[order]
    reach = np.maximum.accumulate(offset + runs.right)
    apart = (offset + runs.left)[1:] >= reach[:-1]
    return runs, np.concatenate(([0], np.cumsum(apart)))


def starts(blob: Indices) -> Indices:
    """Returns the index of each blob's first run."""
    return np.flatnonzero(np.diff(blob, prepend=-1))
