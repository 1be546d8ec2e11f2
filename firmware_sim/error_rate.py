"""The filtered derivative of a control error that does not kick when the reference jumps."""

from __future__ import annotations

import math
from typing import Final

TICK: Final = 0.001  # s, the control period
JUMP: Final = 0.02  # rad/s in one tick (20 rad/s²): faster than any ramp that a wheel follows


def smoothing(time_constant: float) -> float:
    """Returns the gain of a first-order low-pass at the control period; 1 for a time constant of zero."""
    return 1.0 - math.exp(-TICK / time_constant) if time_constant > 0.0 else 1.0


class ErrorRate:
    """de/dt behind a low-pass; on a jump of the reference only the speed is differentiated."""

    __slots__ = ("_gain", "_leak", "_ref", "_speed", "value")

    def __init__(self, time_constant: float) -> None:
        self._gain = smoothing(time_constant) / TICK
        self._leak = self._gain * TICK
        self.reset(0.0, 0.0)

    def reset(self, ref: float, speed: float) -> None:
        self._ref = ref
        self._speed = speed
        self.value = 0.0

    def step(self, ref: float, speed: float) -> float:
        """Returns the rate (rad/s²)."""
        change = self._speed - speed
        jump = ref - self._ref
        if -JUMP < jump < JUMP:
            change += jump
        self._ref = ref
        self._speed = speed
        value = self.value
        self.value = value = value + (self._gain * change - self._leak * value)
        return value
