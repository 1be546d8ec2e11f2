"""A motor, its gear and a wheel, integrated finely by the test itself: independent of the bench's plant.

maxon RE 35, 90 W, 24 V (catalogue): 0.583 Ω, 0.191 mH, 29.2 mN m/A, 67.9 g cm². Gear 33, efficiency 0.8;
at the wheel half of a 9 kg robot as 0.045 kg m², dry friction 0.1 N m, viscous 0.01 N m s.
"""

from __future__ import annotations

import math

COUNTS = 66_000
VOLTAGE = 24.0
_R, _L, _K, _EFFICIENCY = 0.583, 0.191e-3, 0.0292 * 33, 0.8
_INERTIA = 0.045 + 67.9e-7 * 33**2
_STEPS = 20
_H = 1e-3 / _STEPS
_DECAY = math.exp(-_R / _L * _H)


class Wheel:
    """speed (rad/s), current (A), angle (rad) of a wheel; load (N m) acts against forward motion."""

    def __init__(self, speed: float = 0.0) -> None:
        self.speed = speed
        self.current = 0.0
        self.angle = 0.0
        self.load = 0.0

    @property
    def counts(self) -> int:
        return math.floor(self.angle / math.tau * COUNTS)

    def tick(self, duty: float | None) -> None:
        """Lets a millisecond pass at this duty; None: the chopper is open."""
        for _ in range(_STEPS):
            if duty is None:
                self.current = 0.0
            else:
                final = (duty * VOLTAGE - _K * self.speed) / _R
                self.current = final + (self.current - final) * _DECAY
            torque = _EFFICIENCY * _K * self.current - self.load
            friction = 0.1 * math.tanh(self.speed / 0.02) + 0.01 * self.speed
            self.speed += _H * (torque - friction) / _INERTIA
            self.angle += _H * self.speed
