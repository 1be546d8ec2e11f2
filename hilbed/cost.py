"""Where the wall time of a run goes; the only reader of the wall clock outside real-time parts."""

from __future__ import annotations

from collections.abc import Mapping
from time import perf_counter

PARTS = ("physics", "render", "vision", "bus", "drives", "estimator", "controller", "record")


class Cost:
    """Seconds of wall time by part.

    A part adds its own time: `start = perf_counter(); …; cost.physics += perf_counter() - start`.
    `physics` is `stepSimulation` alone, `render` is `getCameraImage` alone. Never part of a hash.
    beside: what of each part other processes have spent meanwhile; it holds the bench up by nothing.
    """

    __slots__ = (*PARTS, "beside")

    def __init__(self) -> None:
        for part in PARTS:
            setattr(self, part, 0.0)
        self.beside = dict.fromkeys(PARTS, 0.0)

    physics: float
    render: float
    vision: float
    bus: float
    drives: float
    estimator: float
    controller: float
    record: float

    def add_beside(self, part: str, spent: float) -> None:
        """Adds the seconds that another process has spent on a part."""
        setattr(self, part, getattr(self, part) + spent)
        self.beside[part] += spent

    def as_dict(self) -> dict[str, float]:
        """Returns the seconds of every part by name."""
        return {part: getattr(self, part) for part in PARTS}


def since(before: Mapping[str, float], now: Mapping[str, float]) -> dict[str, float]:
    """Returns what each part has spent between two readings."""
    return {part: spent - before[part] for part, spent in now.items()}


__all__ = ["PARTS", "Cost", "perf_counter", "since"]
