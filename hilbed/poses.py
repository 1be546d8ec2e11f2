"""A pose moved by odometry."""

from __future__ import annotations

from math import cos, sin

from hilbed.angles import wrap
from hilbed.types import Pose


def moved(pose: Pose, distance: float, turn: float) -> Pose:
    """Moves a pose by an arc of `distance` (m) that turns it by `turn` (rad).

    The chord is taken at ψ + dψ/2 with the arc's length, second order in the turn: Slimane et al. (2014),
    eq. (4) with its T.
    """
    middle = pose.yaw + 0.5 * turn
    return Pose(pose.x + distance * cos(middle), pose.y + distance * sin(middle), wrap(pose.yaw + turn))
