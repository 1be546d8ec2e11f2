"""Where two sets of signals differ: column by column, from when on, by how much."""

from __future__ import annotations

from math import inf
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from hilbed.angles import wrap
from hilbed.record.readings import Signals

POSES = ("estimate", "odometry", "reference")
UNKNOWN = ("t", "truth")
"""What a replay cannot know, or cannot have otherwise."""


class Difference(NamedTuple):
    """A column that is not the same: from when on (s), the largest difference and when (s).

    The difference is infinite where one side has no number, or no row at all.
    """

    column: str
    first: float
    largest: float
    at: float


def differences(recorded: Signals, replayed: Signals) -> list[Difference]:
    """Returns every column that differs in a single bit; rows that only one side has differ, too.

    Not compared: what only the plant knows, and what it has written over (drive/NAME/speed_ref).
    """
    recorded, replayed = _ordered(recorded), _ordered(replayed)
    found = [
        _difference(name, _times(name, recorded, replayed), recorded.get(name), replayed[name])
        for name in compared(replayed)
    ]
    return [difference for difference in found if difference is not None]


def compared(replayed: Signals) -> list[str]:
    """Returns the columns that are compared."""
    return [name for name in replayed if name not in UNKNOWN and not name.endswith("/speed_ref")]


def _ordered(signals: Signals) -> Signals:
    """Returns the signals with the innovations of a moment in an order of their own.

    A record has a column for each kind of readings, so in which order two kinds arrived together is lost.
    """
    columns = {name: column for name, column in signals.items() if name.startswith("nis/")}
    if not columns:
        return signals
    order = np.lexsort((columns["nis/value"], columns["nis/dof"], columns["nis/t"]))
    return {**signals, **{name: column[order] for name, column in columns.items()}}


def _times(name: str, recorded: Signals, replayed: Signals) -> npt.NDArray[Any]:
    """Returns the times (s) of a column's rows, of the longer side."""
    own = name.partition("/")[0] + "/t"
    column = own if own in ("nis/t", "cloud/t") else "t"
    sides = [side.get(column, np.empty(0)) for side in (recorded, replayed)]
    return max(sides, key=len)


def _difference(
    name: str, t: npt.NDArray[Any], was: npt.NDArray[Any] | None, now: npt.NDArray[Any]
) -> Difference | None:
    if was is None or was.shape[1:] != now.shape[1:]:
        return Difference(name, float(t[0]) if len(t) else 0.0, inf, float(t[0]) if len(t) else 0.0)
    common = min(len(was), len(now))
    rows = np.zeros(max(len(was), len(now)))
    rows[common:] = inf
    rows[:common] = _distances(name, was[:common].astype(float), now[:common].astype(float))
    different = np.flatnonzero(rows)
    if not len(different):
        return None
    worst = int(np.argmax(rows))
    return Difference(name, float(t[different[0]]), float(rows[worst]), float(t[worst]))


def _distances(name: str, was: npt.NDArray[Any], now: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Returns the largest difference in each row: 0 where both are the same, both unknown included."""
    apart = np.abs(now - was)
    if name in POSES:
        apart[:, 2] = [abs(wrap(angle)) if np.isfinite(angle) else angle for angle in apart[:, 2]]
    apart[np.isnan(was) & np.isnan(now)] = 0.0
    apart[np.isnan(was) != np.isnan(now)] = inf
    return np.asarray(apart.reshape(len(apart), -1).max(axis=1, initial=0.0))
