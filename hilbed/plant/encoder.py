"""The incremental encoder of a wheel, as its counter is read by the firmware."""

from __future__ import annotations

from collections import deque
from math import floor, tau

from pydantic import Field

from hilbed.spec import Spec
from hilbed.types import ScenarioError

_SPAN = 1 << 32
_HALF = 1 << 31


class EncoderSpec(Spec):
    """resolution: counts a wheel turn (500 lines × 4 × gear 33 by default); latency s, whole ticks, ≤ 1."""

    resolution: int = Field(default=66_000, gt=0, lt=1 << 31)
    latency: float = Field(default=0.0, ge=0, le=1)


class Encoder:
    """Counts a shaft's angle in an I32 that wraps, as it was a latency ago."""

    __slots__ = ("_counts_per_radian", "_pipe")

    def __init__(self, spec: EncoderSpec, dt: float) -> None:
        """dt: tick, s. Raises ScenarioError where the latency is no multiple of it."""
        ticks = round(spec.latency / dt)
        if abs(ticks * dt - spec.latency) > 1e-9:
            raise ScenarioError(f"encoder latency {spec.latency:g} s: not a multiple of the tick, {dt:g} s")
        self._counts_per_radian = spec.resolution / tau
        self._pipe = deque([0] * ticks)

    def sample(self, angle: float) -> int:
        """Takes the angle (rad) now and returns the count read now."""
        count = (floor(angle * self._counts_per_radian) + _HALF) % _SPAN - _HALF
        if not self._pipe:
            return count
        self._pipe.append(count)
        return self._pipe.popleft()
