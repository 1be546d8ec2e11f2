"""A shaft with an inertia, a load and dry friction: what a drive on a desk turns."""

from __future__ import annotations


class Shaft:
    """angle (rad) and speed (rad/s) of the wheel."""

    __slots__ = ("_drag", "_dt", "_load", "_per_torque", "angle", "speed")

    def __init__(self, inertia: float, load: float, friction: float, dt: float) -> None:
        """inertia: kg m², all that turns; load: N m against forward rotation, which also pulls a shaft at
        rest; friction: N m, dry, which only ever stops; dt: tick, s."""
        self._per_torque = dt / inertia
        self._load = load
        self._drag = friction * self._per_torque
        self._dt = dt
        self.angle = self.speed = 0.0

    def step(self, torque: float) -> None:
        """Moves by a tick under a torque (N m, mean over the tick): J dω/dt = τ − load − friction."""
        free = self.speed + (torque - self._load) * self._per_torque
        if free > self._drag:
            speed = free - self._drag
        elif free < -self._drag:
            speed = free + self._drag
        else:
            speed = 0.0
        self.angle += 0.5 * (self.speed + speed) * self._dt
        self.speed = speed
