"""Classical sliding mode: the duty itself switches with the sign of σ = e + λ ė, in a boundary layer."""

from __future__ import annotations

from firmware_sim.error_rate import TICK, ErrorRate
from firmware_sim.loops.gains import Gains, RelayGains


class Relay:
    __slots__ = ("_rate", "_relay", "_slope", "integral")

    def __init__(self, gains: Gains, relay: RelayGains) -> None:
        self._slope = gains.slope
        self._relay = relay
        self._rate = ErrorRate(gains.rate_filter)
        self.integral = 0.0

    def reset(self, ref: float, speed: float, duty: float) -> None:
        self._rate.reset(ref, speed)
        self.integral = duty

    def step(self, ref: float, speed: float, low: float = -1.0, high: float = 1.0) -> float:
        """Returns the duty: A sat(σ/φ), and an integral that carries the load (2011:3 = 0: without)."""
        amplitude, boundary, ki = self._relay
        error = ref - speed
        sigma = error + self._slope * self._rate.step(ref, speed)
        u = amplitude * max(-1.0, min(1.0, sigma / boundary)) + self.integral
        # No back-calculation: the switching part is cut off all the time and would bias the integral.
        integral = self.integral + TICK * ki * error
        self.integral = low if integral < low else high if integral > high else integral
        return low if u < low else high if u > high else u
