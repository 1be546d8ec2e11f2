"""What has moved between a golden record and a new one.

A difference counts when it is above 1e-6 of the largest magnitude that the signal reaches in the golden
record, but 1e-3 of its unit at least: slip is 1e-8 m/s while a wheel rolls, where 1e-14 is already round-off.
Other instruction sets, maths libraries and BLAS kernels move the present records by 3e-9 of that at most.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from hilbed.angles import wrap
from tests.golden.recording import Record

TOLERANCE = 1e-6
SMALLEST_SCALE = 1e-3


class Moved(NamedTuple):
    """A signal or number that is not as it was.

    first, worst: when (s) it left the tolerance and when it was farthest off, NaN for a number; largest:
    difference, in the signal's unit; limit: what would have been allowed.
    """

    name: str
    first: float
    worst: float
    largest: float
    limit: float

    def __str__(self) -> str:
        if np.isnan(self.largest):
            return f"{self.name}: new, gone, of another length, or not known at the same times"
        text = f"{self.name}: {self.largest:.3g} off, allowed {self.limit:.3g}"
        return (
            text if np.isnan(self.first) else f"{text}; from t = {self.first:g} s, most at {self.worst:g} s"
        )


def moved(golden: Record, new: Record) -> list[Moved]:
    """Returns what differs beyond the tolerance, in the order of the golden record, then what is new."""
    found = [] if golden["settings"] == new["settings"] else [_broken("settings")]
    times = np.array(golden["times"])
    for block in ("signals", "numbers"):
        old, present = golden[block], new[block]
        for name in [*old, *(name for name in present if name not in old)]:
            if name not in old or name not in present:
                found.append(_broken(name))
            else:
                found += _difference(name, times, _numbers(old[name]), _numbers(present[name]))
    return found


def _numbers(value: float | list[float | None] | None) -> np.ndarray:
    return np.array(value, dtype=float)


def _difference(name: str, times: np.ndarray, old: np.ndarray, new: np.ndarray) -> list[Moved]:
    if old.shape != new.shape or np.any(np.isnan(old) != np.isnan(new)):
        return [_broken(name)]
    difference = np.nan_to_num(np.abs(new - old))
    if name.endswith("/yaw"):
        difference = np.abs(np.vectorize(wrap)(difference))
    scale = np.max(np.abs(np.nan_to_num(old)), initial=SMALLEST_SCALE)
    limit = TOLERANCE * float(scale)
    if not np.any(difference > limit):
        return []
    if not old.shape:
        return [Moved(name, np.nan, np.nan, float(difference), limit)]
    first, worst = np.argmax(difference > limit), np.argmax(difference)
    return [Moved(name, times[first], times[worst], float(difference[worst]), limit)]


def _broken(name: str) -> Moved:
    return Moved(name, np.nan, np.nan, np.nan, np.nan)
