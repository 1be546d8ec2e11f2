"""The variable-structure (sliding-mode) PI loop: the gains slide, the duty stays continuous.

Slimane et al. 2014, in a form that works with a duty: σ = e + λ ė decides how far the gains rise
above their nominal values; outside a band round σ = 0, on the side that the error is on, they are highest.
"""

from __future__ import annotations

from firmware_sim.error_rate import TICK, ErrorRate
from firmware_sim.loops.gains import Gains


class VariableStructurePi:
    __slots__ = ("_gains", "_rate", "integral")

    def __init__(self, gains: Gains) -> None:
        self._gains = tuple(gains)  # a plain one is taken apart in a fifth of the time
        self._rate = ErrorRate(gains.rate_filter)
        self.integral = 0.0

    def reset(self, ref: float, speed: float, duty: float) -> None:
        self._rate.reset(ref, speed)
        kp, *_ = self._gains
        self.integral = duty - kp * (ref - speed)

    def step(self, ref: float, speed: float, low: float = -1.0, high: float = 1.0) -> float:
        """Returns the duty: u = kp e + ∫ (ki e + k_aw (clip(u) − u)), kp and ki after m(σ)."""
        kp, ki, slope, start, width, kp_rise, ki_rise, reach, _, anti_windup = self._gains
        e = ref - speed
        sigma = e + slope * self._rate.step(ref, speed)
        size = e if e > 0.0 else -e
        m = ((sigma if e > 0.0 else -sigma) - start) / width
        if m > 0.0:
            if m > 1.0:
                m = 1.0
            kp *= 1.0 + kp_rise * m
            if size < reach:
                ki *= 1.0 + ki_rise * m * (1.0 - size / reach)
        integral = self.integral
        u = kp * e + integral
        applied = low if u < low else high if u > high else u
        self.integral = integral + TICK * (ki * e + anti_windup * (applied - u))
        return applied
