"""How well a run in real time has kept its time: what the pacer notes of every cycle, and its summary."""

from __future__ import annotations

from array import array
from bisect import bisect_left
from collections.abc import Mapping
from itertools import pairwise
from typing import Any

from hilbed.clock import seconds
from hilbed.types import Nanos

EDGES_US = (50, 100, 200, 500, 1_000, 2_000, 5_000, 10_000, 20_000, 50_000, 100_000)
"""Upper edges (µs) of the classes of lateness; the last class is open."""


class Ledger:
    """One entry a cycle: its time, by how much it began late (ns of the wall clock), whether it missed.

    A cycle that begins too late has missed its deadline: its commands are not sent.
    """

    def __init__(self) -> None:
        self._t = array("d")
        self._late = array("d")
        self._missed = array("b")

    def note(self, t: Nanos, late: Nanos, missed: bool) -> None:
        """Enters a cycle."""
        self._t.append(seconds(t))
        self._late.append(seconds(late))
        self._missed.append(missed)

    def columns(self) -> dict[str, array[Any]]:
        """Returns `realtime/t` and `realtime/lateness` (both s) and `realtime/missed`, one row a cycle."""
        return {"realtime/t": self._t, "realtime/lateness": self._late, "realtime/missed": self._missed}

    def summary(self, period: Nanos, late_answers: Mapping[str, int]) -> dict[str, Any]:
        """Returns periods and lateness (s), a histogram, and what was missed, as verdict.json has them."""
        late = self._late
        if not late:
            return {"cycles": 0, "missed_deadlines": 0, "late_answers": dict(late_answers)}
        counts = [0] * (len(EDGES_US) + 1)
        for one in late:
            counts[bisect_left(EDGES_US, 1e6 * one)] += 1
        worst = max(range(len(late)), key=late.__getitem__)
        return {
            "cycles": len(late),
            "period": {"nominal": seconds(period), **self._periods()},
            "lateness": {
                "median": sorted(late)[len(late) // 2],
                "p99": sorted(late)[len(late) * 99 // 100],
                "worst": late[worst],
                "worst_at": self._t[worst],
            },
            "histogram": {"up_to_us": [*EDGES_US, None], "cycles": counts},
            "missed_deadlines": sum(self._missed),
            "late_answers": dict(late_answers),
        }

    def _periods(self) -> dict[str, float]:
        """Returns the shortest, mean and longest time (s) between the beginnings of two cycles."""
        begun = [t + late for t, late in zip(self._t, self._late, strict=True)]
        periods = [after - before for before, after in pairwise(begun)]
        if not periods:
            return {}
        return {"min": min(periods), "mean": sum(periods) / len(periods), "max": max(periods)}
