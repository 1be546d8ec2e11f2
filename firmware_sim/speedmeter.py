"""Speed of the wheel from the counts of its encoder, one difference a control period."""

from __future__ import annotations

import math

from firmware_sim.error_rate import TICK, smoothing

_HALF, _TURN = 1 << 31, 1 << 32


class Speedmeter:
    """Differences of a 32-bit counter that wraps, behind a low-pass (s); `speed` in rad/s at the wheel."""

    __slots__ = ("_counts", "_gain", "_scale", "speed")

    def __init__(self, counts_per_turn: int, time_constant: float) -> None:
        self._scale = 2.0 * math.pi / counts_per_turn / TICK
        self._gain = smoothing(time_constant)
        self._counts: int | None = None
        self.speed = 0.0

    def take_over(self, before: Speedmeter) -> None:
        """Goes on where another one, with other parameters, has stopped."""
        self._counts = before._counts
        self.speed = before.speed

    def step(self, counts: int) -> float:
        """Returns the filtered speed; the first counts only give the zero."""
        last = self._counts
        self._counts = counts
        if last is not None:
            moved = counts - last
            if not -_HALF <= moved < _HALF:
                moved = (moved + _HALF) % _TURN - _HALF
            speed = self.speed
            self.speed = speed = speed + self._gain * (moved * self._scale - speed)
            return speed
        return self.speed
