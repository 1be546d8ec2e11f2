"""Whether a reading is what its kind promises."""

from __future__ import annotations

from collections.abc import Mapping

from hilbed.types import Reading

LARGEST = 1e6
"""m or rad: beyond it a reading or its standard deviation is not one."""


def readable(reading: Reading, sizes: Mapping[str, int]) -> bool:
    """Tells whether a reading is of a kind with as many numbers as it should have, all of them believable.

    Standard deviations must be positive. NaN is not believable.
    """
    size = sizes.get(reading.kind)
    if size is None or len(reading.value) != size or len(reading.std) != size:
        return False
    return all(abs(v) < LARGEST for v in reading.value) and all(0 < s < LARGEST for s in reading.std)
