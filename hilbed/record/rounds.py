"""Since when a frame took part in arbitration: what it waits before that is the bus being taken."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hilbed.types import Transfer


def first_rounds(queued: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """Returns when (ns) frames queued at (n,) first arbitrated: at the first start of any frame from then on.

    starts: (m,), rising, of all frames and error frames on the bus, these frames' own among them.
    """
    return np.asarray(starts[np.searchsorted(starts, queued)])


_KEPT = 10_000  # starts: no frame waits longer


class Rounds:
    """Tells of batches of frames, in the order of the wire, how long each lost arbitration to others."""

    def __init__(self) -> None:
        self._starts = np.empty(0, np.int64)

    def lost(self, transfers: Sequence[Transfer]) -> list[float]:
        """Returns s for each frame, attempts that an error frame ended included."""
        times = np.array([transfer[:2] for transfer in transfers], np.int64).reshape(-1, 2)
        queued, start = times[:, 0], times[:, 1]
        self._starts = np.concatenate([self._starts[-_KEPT:], start])
        lost: list[float] = ((start - first_rounds(queued, self._starts)) * 1e-9).tolist()
        return lost
