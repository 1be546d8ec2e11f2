"""How a wheeled robot's pose, and the doubt about it, move with odometry."""

from __future__ import annotations

from math import cos, sin

import numpy as np

from hilbed.angles import wrap
from hilbed.chords import sinc, sinc_slope
from hilbed.estimation.odometry_model import OdometryModel
from hilbed.types import Array


def predicted(
    mean: Array, covariance: Array, step: tuple[float, float], model: OdometryModel
) -> tuple[Array, Array]:
    """Returns the belief (3,), (3, 3) after a step of told odometry (m, rad); the one it came from stays.

    x' = x + l cos a, y' = y + l sin a, ψ' = ψ + dψ with a = ψ + h + direction, h = dψ/2, and the arc's chord
    l = ds sin(h)/h, linearised in the state (F) and in (ds, dψ) (G): P' = F P Fᵀ + G diag(var ds, var dψ) Gᵀ.
    Variances are proportional to the way, so that a step cut in two gains no doubt. Written out by elements,
    which takes a third of the time that products of such small matrices take, and leaves P symmetric to the
    bit.
    """
    x, y, yaw = mean.tolist()
    (xx, xy, xt), (_, yy, yt), (_, _, tt) = covariance.tolist()
    ds, turn = step[0] * model.distance_scale, step[1] * model.turn_scale
    a = yaw + turn / 2 + model.direction
    k, slope = sinc(turn / 2), sinc_slope(turn / 2)
    c, s = cos(a), sin(a)
    gc, gs = k * c, k * s
    dx, dy = ds * gc, ds * gs
    q_ds = model.distance_noise**2 * abs(ds)
    q_turn = model.heading_noise**2 * abs(ds) + model.turn_noise**2 * abs(turn)
    gx, gy = (ds * slope * c - dy) / 2, (ds * slope * s + dx) / 2

    xx += dy * (dy * tt - 2 * xt) + gc * gc * q_ds + gx * gx * q_turn
    yy += dx * (dx * tt + 2 * yt) + gs * gs * q_ds + gy * gy * q_turn
    xy += dx * xt - dy * (yt + dx * tt) + gc * gs * q_ds + gx * gy * q_turn
    xt += gx * q_turn - dy * tt
    yt += gy * q_turn + dx * tt
    tt += q_turn
    moved = np.array((x + dx, y + dy, wrap(yaw + turn)))
    return moved, np.array(((xx, xy, xt), (xy, yy, yt), (xt, yt, tt)))


def symmetric(covariance: Array) -> Array:
    """Returns a covariance without what round-off makes of its symmetry."""
    return 0.5 * (covariance + covariance.T)
