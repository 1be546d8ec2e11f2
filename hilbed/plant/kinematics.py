"""The kinematic unicycle: how a pose moves while speed and yaw rate are held, and what noise does to them.

A tricycle whose inputs are held is a unicycle whose speed and yaw rate are held, so this moves both.
"""

from __future__ import annotations

from collections.abc import Callable
from math import cos, sin
from typing import NamedTuple

from hilbed.angles import wrap
from hilbed.poses import moved
from hilbed.types import Pose, Rng

Twist = tuple[float, float]
"""Speed of the axle's midpoint (m/s) and yaw rate (rad/s)."""

Integrator = Callable[[Pose, Twist, float], Pose]
"""Moves a pose with a held twist over a time (s)."""


def rates(yaw: float, twist: Twist) -> tuple[float, float, float]:
    """Returns ẋ = v cos ψ, ẏ = v sin ψ (m/s), ψ̇ = w (rad/s)."""
    v, w = twist
    return v * cos(yaw), v * sin(yaw), w


def exact(pose: Pose, twist: Twist, T: float) -> Pose:
    """Moves along the arc that a held twist is."""
    return moved(pose, T * twist[0], T * twist[1])


def euler(pose: Pose, twist: Twist, T: float) -> Pose:
    """Moves along the tangent at the start: first order; Bui & Duong (2022), eq. (4.1)."""
    x, y, yaw = rates(pose.yaw, twist)
    return Pose(pose.x + T * x, pose.y + T * y, wrap(pose.yaw + T * yaw))


def rk4(pose: Pose, twist: Twist, T: float) -> Pose:
    """Moves by the classical Runge–Kutta rule, which is Simpson's here: the yaw rate is held."""
    start, end = pose.yaw, pose.yaw + T * twist[1]
    (x1, y1, _), (x2, y2, _), (x3, y3, _) = (rates(a, twist) for a in (start, 0.5 * (start + end), end))
    return Pose(pose.x + T / 6 * (x1 + 4 * x2 + x3), pose.y + T / 6 * (y1 + 4 * y2 + y3), wrap(end))


INTEGRATORS: dict[str, Integrator] = {"exact": exact, "rk4": rk4, "euler": euler}


def advanced(pose: Pose, twist: Twist, T: float, integrator: Integrator, steps: int = 1) -> Pose:
    """Moves a pose over T (s) in equal sub-steps."""
    for _ in range(steps):
        pose = integrator(pose, twist, T / steps)
    return pose


class TwistNoise(NamedTuple):
    """Noise in proportion to the speed: Lages & Alves (2017), eq. (3).

    along: σ_t, m per m; turn: σ_D, rad per m; one draw a period.
    """

    along: float = 0.0
    turn: float = 0.0

    def disturbed(self, twist: Twist, rng: Rng) -> Twist:
        """Returns v + v w_t, w + v w_D; draws two numbers."""
        v, w = twist
        w_t, w_D = rng.normal(0.0, self.along), rng.normal(0.0, self.turn)
        return v + v * w_t, w + v * w_D
