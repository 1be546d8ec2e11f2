"""Where the robot stood and the camera looked while a frame was exposed."""

from __future__ import annotations

from math import remainder, tau
from typing import NamedTuple

from hilbed.angles import wrap
from hilbed.types import Nanos, Pose


class Moment(NamedTuple):
    """Where the robot stands and its camera looks (pan, rad, robot's frame) at t."""

    t: Nanos
    pose: Pose
    pan: float


class Exposure(NamedTuple):
    """A frame's time and the moments, in their order, that are known of the time it was exposed in.

    t: the middle of the exposure of the middle row, for which truth and azimuths hold.
    """

    t: Nanos
    moments: tuple[Moment, ...]

    def at(self, t: Nanos) -> Moment:
        """Returns where things were at t, in proportion between moments and on as before beyond them."""
        moments = self.moments
        if t == moments[0].t:
            return moments[0]
        if len(moments) == 1:
            return moments[0]._replace(t=t)
        after = next((k for k in range(1, len(moments)) if moments[k].t >= t), len(moments) - 1)
        return moments[after] if moments[after].t == t else _on_the_way(moments[after - 1], moments[after], t)


def still(t: Nanos, pose: Pose, pan: float = 0.0) -> Exposure:
    """Returns the exposure of a frame for which everything stands still."""
    return Exposure(t, (Moment(t, pose, pan),))


def _on_the_way(before: Moment, after: Moment, t: Nanos) -> Moment:
    part = (t - before.t) / (after.t - before.t)
    (x, y, yaw), (x2, y2, yaw2) = before.pose, after.pose
    turned = wrap(yaw + part * remainder(yaw2 - yaw, tau))
    pose = Pose(x + part * (x2 - x), y + part * (y2 - y), turned)
    return Moment(t, pose, before.pan + part * remainder(after.pan - before.pan, tau))
