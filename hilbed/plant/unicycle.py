"""The kinematic unicycle, exact by arcs or by Runge–Kutta, with input noise that grows with the speed."""

from __future__ import annotations

from math import cos, sin
from typing import NamedTuple

from hilbed.angles import wrap
from hilbed.types import Command, Pose, Rng

Rates = tuple[float, float, float]


class InputNoise(NamedTuple):
    """Standard deviations per speed: along (−), turn (rad/m). Lages & Alves (2017), σ_t and σ_D."""

    along: float = 0.005
    turn: float = 0.1745


def disturbed(u: Command, noise: InputNoise, rng: Rng) -> Command:
    """Returns u + w, w = v (w_t, w_D), drawn once and meant to be held over one period.

    Lages & Alves (2017), (3). A robot that stands is not disturbed.
    """
    w_t, w_D = rng.standard_normal(2).tolist()
    return Command(u.v + u.v * noise.along * w_t, u.w + u.v * noise.turn * w_D)


def arc(pose: Pose, u: Command, T: float) -> Pose:
    """Returns the pose after `u` was held for T (s): Lages & Alves (2017), (2), with sin(h)/h at h = 0."""
    h = T * u.w / 2
    chord = T * u.v * (sin(h) / h if h else 1.0)
    return Pose(
        pose.x + chord * cos(pose.yaw + h), pose.y + chord * sin(pose.yaw + h), wrap(pose.yaw + 2 * h)
    )


def rk4(pose: Pose, u: Command, T: float, steps: int = 4) -> Pose:
    """Returns the pose after `u` was held for T (s), by fourth-order Runge–Kutta in equal steps.

    Lages & Alves (2017), (1); four steps a period, as in the paper's simulation.
    """
    x, y, yaw = pose
    dt = T / steps
    for _ in range(steps):
        k1 = _rates(yaw, u)
        k2 = _rates(yaw + dt / 2 * k1[2], u)
        k3 = _rates(yaw + dt / 2 * k2[2], u)
        k4 = _rates(yaw + dt * k3[2], u)
        dx, dy, turn = (dt / 6 * (a + 2 * b + 2 * c + d) for a, b, c, d in zip(k1, k2, k3, k4, strict=True))
        x, y, yaw = x + dx, y + dy, yaw + turn
    return Pose(x, y, wrap(yaw))


def _rates(yaw: float, u: Command) -> Rates:
    return u.v * cos(yaw), u.v * sin(yaw), u.w
