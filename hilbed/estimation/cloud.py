"""A pose believed as a cloud of particles: (M, 3) rows x, y (m), yaw (rad)."""

from __future__ import annotations

from math import isqrt
from typing import NamedTuple

import numpy as np

from hilbed.angle_arrays import sinc, wrap
from hilbed.types import Array, Pose, Rng


class WayNoise(NamedTuple):
    """Noise per way in one period: along (m/m), turn (rad/m). Lages & Alves (2017), σ_t and σ_D."""

    along: float = 0.005
    turn: float = 0.1745


def cloud_of(x: Array, y: Array, yaw: Array) -> Array:
    """Returns the cloud (M, 3) of three columns (M,), each contiguous in memory."""
    return np.stack((x, y, yaw)).T


def lattice(centre: Pose, count: int, side: float) -> Array:
    """Returns `count` particles (M, 3), equally spaced over a square of `side` (m), edges included.

    The square lies along the map's axes; yaw is the centre's. A count that is no square number fills the
    smallest square lattice that holds it row by row. Raises ValueError where count is not positive.
    """
    if count < 1:
        raise ValueError(f"a cloud has at least one particle, not {count}")
    n = isqrt(count - 1) + 1
    offsets = np.linspace(-side / 2, side / 2, n) if n > 1 else np.zeros(1)
    y, x = np.divmod(np.arange(count), n)
    return cloud_of(centre.x + offsets[x], centre.y + offsets[y], np.full(count, centre.yaw))


def advanced(cloud: Array, distance: Array, turn: Array) -> Array:
    """Returns the cloud (M, 3) after arcs of distance (m) and turn (rad), scalars or (M,) each.

    Lages & Alves (2017), (2): a chord of distance · sin(h)/h at yaw + h, h = turn/2.
    """
    x, y, yaw = cloud.T
    h = turn / 2
    chord = distance * sinc(h)
    a = yaw + h
    return cloud_of(x + chord * np.cos(a), y + chord * np.sin(a), wrap(yaw + turn))


def predicted(cloud: Array, distance: float, turn: float, noise: WayNoise, rng: Rng) -> Array:
    """Returns the cloud (M, 3) after one period of told odometry (m, rad), each particle with its own noise.

    Lages & Alves (2017), (9), with T u₁ = distance, T u₂ = turn: half of the variance of the turn acts along
    the arc, half at its end, σ_d = σ_D/√2. A robot that stands is not disturbed.
    """
    if distance == 0:
        return advanced(cloud, np.zeros(()), np.asarray(turn))
    w_t, w_d1, w_d2 = distance * rng.standard_normal((3, len(cloud)))
    sigma_d = noise.turn / np.sqrt(2)
    moved = advanced(cloud, distance + noise.along * w_t, turn + sigma_d * w_d1)
    moved[:, 2] = wrap(moved[:, 2] + sigma_d * w_d2)
    return moved


def summary(cloud: Array) -> tuple[Array, Array]:
    """Returns mean (3,) and covariance (3, 3) of a cloud (M, 3).

    The yaw's mean is the direction of the mean unit vector, its deviations are wrapped.
    """
    x, y, yaw = cloud.T
    mean = np.array((x.mean(), y.mean(), np.arctan2(np.sin(yaw).mean(), np.cos(yaw).mean())))
    deviation = (cloud - mean).T
    deviation[2] = wrap(deviation[2])
    return mean, deviation @ deviation.T / len(cloud)
