"""Which beacon an anonymous reading belongs to."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

Squared = float


def nearest(squared: Sequence[Sequence[Squared]], taken: Iterable[int] = ()) -> list[int | None]:
    """Gives each reading the nearest beacon that is still free, closest pair first.

    squared: Mahalanobis distances v²/S at the prior, one row a reading, one column a beacon; taken:
    beacons that are not free. Returns a beacon for each reading, None when there are none left.
    """
    pairs = sorted((d, i, j) for i, row in enumerate(squared) for j, d in enumerate(row))
    owner: list[int | None] = [None] * len(squared)
    used = set(taken)
    for _, i, j in pairs:
        if owner[i] is None and j not in used:
            owner[i] = j
            used.add(j)
    return owner
