"""Signals of a finished run as metrics see them: with a word for what is missing, and cut to a window."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from typing import Any

    import numpy as np

Column: TypeAlias = "np.ndarray[Any, Any]"


class Missing(Exception):
    """A signal that a metric needs and the run does not have."""


class Signals(dict[str, Column]):
    """Columns by their names in signals.npz; asking for an absent one raises Missing."""

    def __missing__(self, name: str) -> Column:
        raise Missing(f"the run has no {name}")

    def drives(self) -> list[str]:
        """Returns the names of the drives, in alphabetical order."""
        return sorted({name.split("/")[1] for name in self if name.startswith("drive/")})

    def drive(self, name: str, field: str) -> Column:
        """Returns a drive's signal at the tick, (M,), or at the cycle, (N,), where there is no tick log."""
        tick = f"tick/drive/{name}/{field}"
        return self[tick if tick in self else f"drive/{name}/{field}"]

    def drive_time(self, name: str) -> Column:
        """Returns the times (s) of the rows of `drive`."""
        return self["tick/t" if f"tick/drive/{name}/speed" in self else "t"]


TIMELESS = "beacons"


def window(signals: Mapping[str, Column], start: float, end: float) -> Signals:
    """Returns the rows of every signal whose own time lies in [start, end] (s); beacons have no time."""
    kept: dict[str, Column] = {}
    cut = Signals()
    for name, column in signals.items():
        if name == TIMELESS:
            cut[name] = column
            continue
        time = _time_of(name, signals)
        if time not in kept:
            slack = 1e-9  # a limit of 0.3 s means the row at 3 · 0.1 s, too
            kept[time] = (signals[time] >= start - slack) & (signals[time] <= end + slack)
        cut[name] = column[kept[time]]
    return cut


def _time_of(name: str, signals: Mapping[str, Column]) -> str:
    own = f"{name.split('/')[0]}/t"
    return own if own in signals else "t"
