"""The robot's recent way, so that a late reading meets the pose of its own time."""

from __future__ import annotations

from collections import deque
from math import cos, sin

import numpy as np

from hilbed.angle_arrays import wrap
from hilbed.chords import chord
from hilbed.estimation.cloud import cloud_of
from hilbed.types import Array, Nanos, Pose

STANDSTILL = Pose(0.0, 0.0, 0.0)


class Trail:
    """Told odometry of the last `memory` ns; increments are believed, arcs exact."""

    def __init__(self, memory: Nanos) -> None:
        self._memory = memory
        self._steps: deque[tuple[Nanos, Nanos, float, float]] = deque()

    @property
    def end(self) -> Nanos:
        """The stamp of the newest increment, 0 before the first."""
        return self._steps[-1][1] if self._steps else 0

    def extend(self, t: Nanos, distance: float, turn: float) -> None:
        """Adds an increment (m, rad) that ends at `t`; what does not move time on is not remembered."""
        if t > self.end:
            self._steps.append((self.end, t, distance, turn))
        while self._steps and self._steps[0][1] < t - self._memory:
            self._steps.popleft()

    def remembers(self, t: Nanos) -> bool:
        """Tells whether the way since `t` is known."""
        return t >= (self._steps[0][0] if self._steps else 0)

    def since(self, t: Nanos) -> Pose:
        """Returns the motion from `t` to the newest increment, in the robot's frame at `t`.

        An increment that was under way at `t` counts by its share of time.
        """
        motion = STANDSTILL
        for start, end, distance, turn in self._steps:
            if end > t:
                share = (end - max(start, t)) / (end - start)
                motion = compose(motion, arc_motion(share * distance, share * turn))
        return motion


def arc_motion(distance: float, turn: float) -> Pose:
    """Returns where an arc of `distance` (m) and `turn` (rad) leads, seen from its beginning."""
    length, direction = chord(distance, turn)
    return Pose(length * cos(direction), length * sin(direction), turn)


def compose(first: Pose, second: Pose) -> Pose:
    """Returns the motion of two motions, one after the other; the turn is not wrapped."""
    c, s = cos(first.yaw), sin(first.yaw)
    return Pose(
        first.x + c * second.x - s * second.y,
        first.y + s * second.x + c * second.y,
        first.yaw + second.yaw,
    )


def inverse(motion: Pose) -> Pose:
    """Returns the motion that takes a motion back."""
    c, s = cos(motion.yaw), sin(motion.yaw)
    return Pose(-c * motion.x - s * motion.y, s * motion.x - c * motion.y, -motion.yaw)


def carried(cloud: Array, motion: Pose) -> Array:
    """Returns the cloud (M, 3) after each particle has made the same motion in its own frame."""
    if motion == STANDSTILL:
        return cloud
    x, y, yaw = cloud.T
    c, s = np.cos(yaw), np.sin(yaw)
    return cloud_of(x + c * motion.x - s * motion.y, y + s * motion.x + c * motion.y, wrap(yaw + motion.yaw))
