"""A plain PI loop with the nominal gains: what the variable structure is measured against."""

from __future__ import annotations

from firmware_sim.error_rate import TICK
from firmware_sim.loops.gains import Gains


class FixedPi:
    __slots__ = ("_gains", "integral")

    def __init__(self, gains: Gains) -> None:
        self._gains = gains
        self.integral = 0.0

    def reset(self, ref: float, speed: float, duty: float) -> None:
        self.integral = duty - self._gains.kp * (ref - speed)

    def step(self, ref: float, speed: float, low: float = -1.0, high: float = 1.0) -> float:
        """Returns the duty; the integral is bled by what the bounds cut off (back-calculation)."""
        gains = self._gains
        error = ref - speed
        u = gains.kp * error + self.integral
        applied = low if u < low else high if u > high else u
        self.integral += TICK * (gains.ki * error + gains.anti_windup * (applied - u))
        return applied
