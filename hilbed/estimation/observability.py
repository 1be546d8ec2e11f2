"""Whether bearings to landmarks at unknown distance tell the state: the rank condition of Ishikawa & Sampei.

Hermann & Krener (1977): gradients of h and of its Lie derivatives span the state space. Rows run to
L_f^(n−1); the paper's Theorem 4.3 says n. f is the motion per metre, g what curvature does.
"""

from __future__ import annotations

import numpy as np

from hilbed.estimation.sights import Survey, sight_jacobian
from hilbed.types import Array


def reduced_determinant(r: Array, phi: Array) -> Array:
    """Returns −sin φ / r² (1/m²), eq. (11): zero where the robot's axis passes through the landmark."""
    return np.asarray(-np.sin(phi) / np.square(r))


def full_determinant(path: Array) -> Array:
    """Returns l sin φ_A sin φ_B / (r_A r_B)³ (1/m⁵) of states (..., 4) x, y, θ, l, without steering."""
    x, y, yaw, l = np.moveaxis(np.asarray(path, dtype=float), -1, 0)  # noqa: E741
    a, b = np.hypot(x, y), np.hypot(x, y - l)
    across_a, across_b = (np.sin(yaw - np.arctan2(away, x)) for away in (y, y - l))
    return np.asarray(l * across_a * across_b / (a * b) ** 3)


def reduced_rows(r: float, phi: float, steering: bool) -> Array:
    """Returns gradients (2 or 3, 2) over (r, φ) of φ, L_f φ = −sin φ / r and, steering, L_g L_f φ."""
    rows = [(0.0, 1.0), (np.sin(phi) / r**2, -np.cos(phi) / r)]
    if steering:
        rows.append((np.cos(phi) / r**2, np.sin(phi) / r))
    return np.array(rows)


def full_rows(state: Survey, steering: bool) -> Array:
    """Returns the same gradients over (x, y, θ, l) of both bearings, (4 or 6, 4)."""
    J = sight_jacobian(state)
    x, y, yaw, l = state  # noqa: E741
    blocks = []
    for k, away in ((0, y), (2, y - l)):
        r, phi = float(np.hypot(x, away)), yaw - float(np.arctan2(away, x))
        blocks.append(reduced_rows(r, phi, steering) @ J[k : k + 2])
    return np.vstack(blocks)


def observable(rows: Array, tolerance: float = 1e-3) -> bool:
    """Tells whether gradients span the state space: smallest singular value over largest above a tolerance.

    False where a number is not finite: the robot stands on a landmark.
    """
    if not np.isfinite(rows).all():
        return False
    values = np.linalg.svd(rows, compute_uv=False)
    return bool(values[-1] > tolerance * values[0])
