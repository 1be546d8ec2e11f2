"""A pose moved by odometry."""

from __future__ import annotations

from math import cos, sin

from hilbed.angles import wrap
from hilbed.chords import chord
from hilbed.types import Pose


def moved(pose: Pose, distance: float, turn: float) -> Pose:
    """Moves a pose by an arc of `distance` (m) that turns it by `turn` (rad), exactly.

    Slimane et al. (2014), eq. (4), has the arc's length in place of its chord's.
    """
    length, direction = chord(distance, turn)
    middle = pose.yaw + direction
    return Pose(pose.x + length * cos(middle), pose.y + length * sin(middle), wrap(pose.yaw + turn))
