"""Point stabilisation of a unicycle: a law for one pose, computed for a whole cloud at once."""

from __future__ import annotations

from math import cos, sin
from typing import NamedTuple

import numpy as np

from hilbed.angle_arrays import sinc, wrap
from hilbed.types import Array, Command, Pose


class Gains(NamedTuple):
    """γ₁, γ₂ (1/s) and h of Lages & Alves (2017); guard (m): below it ψ := 0, 0 for the law as printed."""

    gamma_1: float = 0.5
    gamma_2: float = 0.5
    h: float = 1.0
    guard: float = 0.05


def relative(cloud: Array, goal: Pose) -> tuple[Array, Array, Array]:
    """Returns x̄ (M,), ȳ (M,) in m and yaw (M,) in rad of poses (M, 3) in the goal's frame: (10)."""
    c, s = cos(goal.yaw), sin(goal.yaw)
    dx, dy = cloud[:, 0] - goal.x, cloud[:, 1] - goal.y
    return c * dx + s * dy, c * dy - s * dx, wrap(cloud[:, 2] - goal.yaw)


def stabilising(cloud: Array, goal: Pose, gains: Gains) -> tuple[Array, Array]:
    """Returns u₁ (M,) in m/s and u₂ (M,) in rad/s that bring each pose (M, 3) to the goal.

    Lages & Alves (2017), (12) to (17). (16) is written γ₁ e cos α = γ₁ (x̄₁ cos x̄₃ + x̄₂ sin x̄₃), which needs
    no ψ; in (17) cos α sin α / α = sin 2α / 2α, 1 at α = 0. At e = 0 the direction ψ does not exist and
    counts as 0; near the goal it is the noise of the estimate, therefore the guard. α is in (−π, π].
    """
    g1, g2, h, guard = gains
    x1, x2, x3 = relative(cloud, goal)
    psi = np.arctan2(x2, x1)
    psi[x1 * x1 + x2 * x2 < guard * guard] = 0.0
    alpha = wrap(x3 - psi)
    u1 = -g1 * (x1 * np.cos(x3) + x2 * np.sin(x3))
    u2 = -g2 * alpha - g1 * sinc(2 * alpha) * (alpha - h * psi)
    return u1, u2


def within_wheel_limit(u: Command, half_track: float, wheel_speed: float) -> Command:
    """Returns the command scaled, both inputs alike, so that neither wheel is faster than allowed.

    |v| + b |w| ≤ wheel_speed (m/s), b = half_track (m). The path's curvature v/w stays. Lages & Alves
    (2017), Fig. 6.
    """
    fastest = abs(u.v) + half_track * abs(u.w)
    if fastest <= wheel_speed:
        return u
    return Command(u.v * wheel_speed / fastest, u.w * wheel_speed / fastest)
