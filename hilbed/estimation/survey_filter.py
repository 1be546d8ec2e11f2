"""Extended Kalman filter of both sights together: the full form (6) of Ishikawa & Sampei (1994).

The paper splits it into two filters of two states, which loses what their errors have in common. Its
states are 1/r and φ of each landmark: a bearing is a state and parallax is linear in 1/r, so that a wrong
first guess of the distances does not lead it astray, as it does in x, y, θ, l or with r (Civera, Davison,
Montiel, Inverse Depth Parametrization for Monocular SLAM, 2008).
"""

from __future__ import annotations

from cmath import phase, rect
from typing import NamedTuple

import numpy as np

from hilbed.angles import wrap
from hilbed.chords import chord
from hilbed.estimation.bearing_observers import FARTHEST, NEAREST
from hilbed.estimation.motion import symmetric
from hilbed.estimation.odometry_model import OdometryModel
from hilbed.estimation.sights import Sight
from hilbed.types import Array


class Belief(NamedTuple):
    """Both sights (m, rad) and the covariance (4, 4) of 1/r_A, φ_A, 1/r_B, φ_B."""

    a: Sight
    b: Sight
    P: Array


def started(a: Sight, b: Sight, distance_std: float, bearing_std: float) -> Belief:
    """Returns the belief from two measured angles and two guessed distances (m) with their deviations."""
    deviations = distance_std / a.r**2, bearing_std, distance_std / b.r**2, bearing_std
    return Belief(a, b, np.diag(deviations) ** 2)


def sights_covariance(belief: Belief) -> Array:
    """Returns the covariance (4, 4) of r_A, φ_A, r_B, φ_B."""
    D = np.diag((-(belief.a.r**2), 1.0, -(belief.b.r**2), 1.0))
    return np.asarray(D @ belief.P @ D)


def carried(sight: Sight, step: tuple[float, float]) -> tuple[Sight, Array, Array]:
    """Returns a sight after an arc (m, rad), and derivatives (2, 2) of (1/r, φ) by themselves and the step.

    The robot as seen from the landmark, in axes along its heading, is r exp(−iφ); the arc adds its chord, and
    turns the axes.
    """
    ds, turn = step
    length, direction = chord(ds, turn)
    back, before = rect(1.0, -turn), rect(1.0, -sight.phi)
    way, unit = rect(length, direction), rect(1.0, direction)
    q = (sight.r * before + way) * back
    r = max(abs(q), NEAREST)
    changes = (
        -(sight.r**2) * before * back,
        -1j * sight.r * before * back,
        unit * back,
        0.5j * way * back - 1j * q,
    )
    rows = [(q.conjugate() * dq for dq in pair) for pair in (changes[:2], changes[2:])]
    by_sight, by_step = (np.array([(-p.real / r**3, -p.imag / r**2) for p in row]).T for row in rows)
    return Sight(min(r, FARTHEST), wrap(-phase(q))), by_sight, by_step


def moved_on(belief: Belief, step: tuple[float, float], model: OdometryModel) -> Belief:
    """Returns the belief after an odometry increment (m, rad), whose noise both sights share."""
    ds, turn = step[0] * model.distance_scale, step[1] * model.turn_scale
    a, F_a, G_a = carried(belief.a, (ds, turn))
    b, F_b, G_b = carried(belief.b, (ds, turn))
    F, G = np.zeros((4, 4)), np.vstack((G_a, G_b))
    F[:2, :2], F[2:, 2:] = F_a, F_b
    Q = model.distance_noise**2 * abs(ds), model.heading_noise**2 * abs(ds) + model.turn_noise**2 * abs(turn)
    return Belief(a, b, symmetric(F @ belief.P @ F.T + G @ np.diag(Q) @ G.T))


def surprise(belief: Belief, landmark: int, phi: float, variance: float) -> tuple[float, float]:
    """Returns innovation (rad) and its variance (rad²) of a φ measured of landmark A (0) or B (1)."""
    index = 2 * landmark + 1
    return wrap(phi - (belief.a, belief.b)[landmark].phi), float(belief.P[index, index]) + variance


def corrected(belief: Belief, landmark: int, phi: float, variance: float) -> Belief:
    """Returns the belief after a measured φ with a variance (rad²), in Joseph's form."""
    v, S = surprise(belief, landmark, phi, variance)
    H = np.eye(4)[2 * landmark + 1]
    K = belief.P @ H / S
    (ra, fa, rb, fb), A = (K * v).tolist(), np.eye(4) - np.outer(K, H)
    P = symmetric(A @ belief.P @ A.T + variance * np.outer(K, K))
    return Belief(_shifted(belief.a, ra, fa), _shifted(belief.b, rb, fb), P)


def _shifted(sight: Sight, inverse: float, phi: float) -> Sight:
    rho = min(max(1.0 / sight.r + inverse, 1.0 / FARTHEST), 1.0 / NEAREST)
    return Sight(1.0 / rho, wrap(sight.phi + phi))
