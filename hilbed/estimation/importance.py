"""How well each particle explains a measured pose or position."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hilbed.angle_arrays import wrap
from hilbed.types import Array

FARTHEST = 1490.0
"""Squared distance (in standard deviations) beyond which exp(−d²/2) is zero in double precision."""


def squared_distances(cloud: Array, value: Sequence[float], std: Sequence[float]) -> Array:
    """Returns vᵀ P⁻¹ v (M,) of the innovations v = value − particle, the yaw's wrapped.

    value, std: x, y (m) and, where it is measured, yaw (rad); P = diag(std²). Lages & Alves (2017), the
    exponent of f_y, which is printed with P in place of its inverse.
    """
    squared: Array = np.square((value[0] - cloud[:, 0]) / std[0])
    squared += np.square((value[1] - cloud[:, 1]) / std[1])
    if len(value) > 2:
        squared += np.square(wrap(value[2] - cloud[:, 2]) / std[2])
    return squared


def importance(squared: Array) -> Array | None:
    """Returns the weights (M,) of squared distances (M,): proportional to exp(−d²/2), the largest is 1.

    None where the likelihood of every particle is zero in double precision: none of them explains the
    reading, and which one is the least wrong says nothing.
    """
    nearest = squared.min()
    if not nearest < FARTHEST:
        return None
    weights: Array = np.exp((nearest - squared) / 2)
    return weights
