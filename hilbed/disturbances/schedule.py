"""Which disturbances act at a moment: each has a start and a length, and is asked only in between."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeAlias

from hilbed.clock import NEVER, nanos
from hilbed.effects import Effects, Surroundings
from hilbed.spec import NonNegative, Positive, Spec
from hilbed.types import Nanos, Rng

Disturbance: TypeAlias = Callable[[Nanos, Surroundings, Effects], Nanos]
"""Writes what it does at a time since its own start; returns for how long (ns) that stays the same."""

STEADY: Nanos = NEVER
"""Holds as long as the disturbance is active."""


class DisturbanceBase(Spec):
    """What every disturbance has: when it starts (s) and how long it lasts (s, for good if left out).

    A size with a `spread` (standard deviation) is drawn once a run, from the run's seed.
    """

    start: NonNegative = 0.0
    length: Positive | None = None


def drawn(size: float, spread: float, rng: Rng) -> float:
    """Returns a size for this run: normal round `size` with standard deviation `spread`, the same unit."""
    return size + spread * float(rng.standard_normal())


class Schedule:
    """Applies the disturbances that are active; `effects` holds the result until the next call.

    listeners: told the time and the effects whenever they may have changed.
    """

    def __init__(self, entries: Sequence[tuple[DisturbanceBase, Disturbance]], effects: Effects) -> None:
        self.effects = effects
        self.listeners: list[Callable[[Nanos, Effects], None]] = []
        self._entries = [(nanos(spec.start), _end(spec), disturbance) for spec, disturbance in entries]
        self._active: list[tuple[Nanos, Disturbance]] = []
        self._edge: Nanos = 0  # when the next one starts or ends
        self._again: Nanos = 0  # when one of them has to be asked again

    def apply(self, t: Nanos, surroundings: Surroundings) -> None:
        """Brings the effects to their state for the tick that starts at `t`."""
        if t < self._again:
            return
        if t >= self._edge:
            self._switch(t)
        self.effects.reset()
        self._again = self._edge
        for start, disturbance in self._active:
            held = disturbance(t - start, surroundings, self.effects)
            self._again = min(self._again, t + held)
        for listen in self.listeners:
            listen(t, self.effects)

    def _switch(self, t: Nanos) -> None:
        self._active = [(start, act) for start, end, act in self._entries if start <= t < end]
        edges = [edge for start, end, _ in self._entries for edge in (start, end) if edge > t]
        self._edge = min(edges, default=NEVER)


def _end(spec: DisturbanceBase) -> Nanos:
    return NEVER if spec.length is None else nanos(spec.start) + nanos(spec.length)
