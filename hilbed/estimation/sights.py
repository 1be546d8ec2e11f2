"""Two landmarks seen from a robot: polar coordinates of Ishikawa & Sampei (1994) and back.

Landmark A is the origin, B is (0, l) with l unknown; ψ = atan2 of the robot as seen from the landmark,
φ = wrap(θ − ψ). The azimuth at which a camera on the robot sees the landmark is wrap(π − φ).
"""

from __future__ import annotations

from math import atan2, cos, hypot, pi, sin
from typing import NamedTuple

import numpy as np

from hilbed.angles import wrap
from hilbed.types import Array, Pose

UNKNOWN = 1e6  # m², rad²: no idea
CLOSEST = 1e-6  # m: landmarks nearer to each other than that have no direction from one to the other


class Sight(NamedTuple):
    """One landmark: its distance r (m) and φ (rad), the heading against the ray from it to the robot."""

    r: float
    phi: float


class Survey(NamedTuple):
    """The full state: pose in the landmarks' frame and their distance l (m)."""

    x: float
    y: float
    yaw: float
    l: float  # noqa: E741 the paper's symbol


def angle(azimuth: float) -> float:
    """Converts an azimuth in the robot's frame to φ, and φ to an azimuth (rad)."""
    return wrap(pi - azimuth)


def sight(pose: Pose, landmark: tuple[float, float]) -> Sight:
    """Returns how a landmark (m) is seen from a pose; eq. (5) with atan2."""
    x, y = pose.x - landmark[0], pose.y - landmark[1]
    return Sight(hypot(x, y), wrap(pose.yaw - atan2(y, x)))


def surveyed(a: Sight, b: Sight) -> Survey:
    """Returns the full state of which A and B are the sights; eq. (8) with its misprints mended.

    At l = 0, where no frame can be told, l counts as CLOSEST.
    """
    turn = b.phi - a.phi
    along = a.r * b.r * cos(turn)
    l = max(max(a.r * a.r + b.r * b.r - 2.0 * along, 0.0) ** 0.5, CLOSEST)  # noqa: E741
    x, y = a.r * b.r * sin(turn) / l, (a.r * a.r - along) / l
    return Survey(x, y, wrap(a.phi + atan2(y, x)), l)


def sight_jacobian(state: Survey) -> Array:
    """Returns ∂(r_A, φ_A, r_B, φ_B)/∂(x, y, θ, l), (4, 4); its determinant is l / (r_A r_B)."""
    x, y, _, l = state  # noqa: E741
    rows = []
    for ahead, in_l in ((y, 0.0), (y - l, -1.0)):
        r2 = max(x * x + ahead * ahead, CLOSEST**2)
        r = r2**0.5
        rows.append((x / r, ahead / r, 0.0, in_l * ahead / r))
        rows.append((ahead / r2, -x / r2, 1.0, in_l * -x / r2))
    return np.array(rows)


def surveyed_covariance(state: Survey, sights: Array) -> Array:
    """Returns the covariance (4, 4) of the full state from that of (r_A, φ_A, r_B, φ_B).

    Where the landmarks are one, or far away, the sights do not tell all of it: UNKNOWN on the diagonal.
    """
    J = sight_jacobian(state)
    if abs(np.linalg.det(J)) < CLOSEST:
        return UNKNOWN * np.eye(4)
    inverse = np.linalg.inv(J)
    covariance: Array = inverse @ sights @ inverse.T
    return 0.5 * (covariance + covariance.T)
