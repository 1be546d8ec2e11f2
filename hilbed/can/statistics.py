"""What a wire has carried so far."""

from __future__ import annotations

from typing import NamedTuple

from hilbed.types import Nanos


class Statistics(NamedTuple):
    """Totals of a wire: frames received, time the bus was taken (interframe spaces included), worst wait.

    worst_latency: the longest time from queueing to the first bit on the bus; errors: error frames.
    """

    t: Nanos
    frames: int
    busy: Nanos
    worst_latency: Nanos
    errors: int = 0


def load(before: Statistics, after: Statistics) -> float:
    """Returns the bus load between two snapshots, 0 to 1 (frames count where they end)."""
    return (after.busy - before.busy) / (after.t - before.t) if after.t > before.t else 0.0
