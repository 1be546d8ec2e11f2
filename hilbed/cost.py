"""Where the wall time of a run goes; the only reader of the wall clock outside real-time parts."""

from __future__ import annotations

from time import perf_counter

PARTS = ("physics", "render", "vision", "bus", "drives", "estimator", "controller", "record")


class Cost:
    """Seconds of wall time by part.

    A part adds its own time: `start = perf_counter(); …; cost.physics += perf_counter() - start`.
    `physics` is `stepSimulation` alone, `render` is `getCameraImage` alone. Never part of a hash.
    """

    __slots__ = PARTS

    def __init__(self) -> None:
        for part in PARTS:
            setattr(self, part, 0.0)

    physics: float
    render: float
    vision: float
    bus: float
    drives: float
    estimator: float
    controller: float
    record: float

    def as_dict(self) -> dict[str, float]:
        """Returns the seconds of every part by name."""
        return {part: getattr(self, part) for part in PARTS}


__all__ = ["PARTS", "Cost", "perf_counter"]
