"""How a wheeled robot's pose, and the doubt about it, move with odometry."""

from __future__ import annotations

from math import cos, sin
from typing import NamedTuple

import numpy as np

from hilbed.angles import wrap
from hilbed.types import Array


class OdometryModel(NamedTuple):
    """What is known about an odometer: its systematic errors and its noise.

    direction: of travel in the robot's frame (rad), 0 where wheels and frame are aligned; scales: true
    over told; noise: standard deviations that grow with the root of the way: distance (m/√m), heading
    (rad/√m), and heading from turning (rad/√rad).
    """

    direction: float = 0.0
    distance_scale: float = 1.0
    turn_scale: float = 1.0
    distance_noise: float = 0.05
    heading_noise: float = 0.1
    turn_noise: float = 0.05


class Motion(NamedTuple):
    """A small step: change of state (3,), its Jacobian F (3, 3) and noise covariance Q (3, 3)."""

    change: Array
    F: Array
    Q: Array


def motion(yaw: float, distance: float, turn: float, model: OdometryModel) -> Motion:
    """Returns the step that told odometry (m, rad) means for a robot at `yaw` (rad).

    x' = x + ds cos a, y' = y + ds sin a, ψ' = ψ + dψ with a = ψ + dψ/2 + direction, linearised in the
    state (F) and in (ds, dψ) (G); Q = G diag(var ds, var dψ) Gᵀ. Variances are proportional to the way,
    so that a step cut in two gains no doubt.
    """
    ds, turn = distance * model.distance_scale, turn * model.turn_scale
    a = yaw + turn / 2 + model.direction
    c, s = cos(a), sin(a)
    dx, dy = ds * c, ds * s
    F = np.array(((1.0, 0.0, -dy), (0.0, 1.0, dx), (0.0, 0.0, 1.0)))
    q_ds = model.distance_noise**2 * abs(ds)
    q_turn = model.heading_noise**2 * abs(ds) + model.turn_noise**2 * abs(turn)
    gx, gy = -dy / 2, dx / 2
    xy = c * s * q_ds + gx * gy * q_turn
    Q = np.array(
        (
            (c * c * q_ds + gx * gx * q_turn, xy, gx * q_turn),
            (xy, s * s * q_ds + gy * gy * q_turn, gy * q_turn),
            (gx * q_turn, gy * q_turn, q_turn),
        )
    )
    return Motion(np.array((dx, dy, turn)), F, Q)


def predicted(
    mean: Array, covariance: Array, step: tuple[float, float], model: OdometryModel
) -> tuple[Array, Array]:
    """Returns the belief (3,), (3, 3) after a step of odometry (m, rad); the one it came from stays."""
    change, F, Q = motion(float(mean[2]), *step, model)
    moved = mean + change
    moved[2] = wrap(float(moved[2]))
    return moved, symmetric(F @ covariance @ F.T + Q)


def symmetric(covariance: Array) -> Array:
    """Returns a covariance without what round-off makes of its symmetry."""
    return 0.5 * (covariance + covariance.T)
