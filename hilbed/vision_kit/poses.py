"""Where the robot stands, and how its camera is turned, in each frame of a dataset."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, cos, hypot, pi, sin
from typing import Protocol

from hilbed import rng
from hilbed.angles import wrap
from hilbed.clock import nanos, seconds
from hilbed.ports import Reference
from hilbed.poses import moved
from hilbed.scene import BeaconSpec
from hilbed.sensors import CameraSpec
from hilbed.sensors.exposure import Exposure, Moment
from hilbed.sensors.pan import make_pan
from hilbed.types import Nanos, Pose, Rng

CLEARANCE = 0.3  # m from any beacon's axis: the camera is never inside one
TRIES = 100
SPEEDS, YAW_RATES = (0.0, 0.5), (-0.5, 0.5)  # m/s, rad/s
AROUND = 0.1  # s before and after a frame's time of which is told where the robot was
MOMENTS = 5  # on either side of a frame's time


def around(camera: CameraSpec) -> tuple[Nanos, ...]:
    """Returns moments relative to a frame's time, over all that its exposure and readout may take."""
    step = nanos(max(AROUND, (camera.exposure + camera.readout) / 2)) // MOMENTS
    return tuple(k * step for k in range(-MOMENTS, MOMENTS + 1))


class Poses(Protocol):
    def at(self, k: int) -> Exposure:
        """Returns where frame k is taken, the same in whatever order they are asked for."""
        ...


class AlongPath:
    """On the reference, `step` apart in time; an axis that tracks a beacon looks right at it."""

    def __init__(
        self, reference: Reference, beacons: Sequence[BeaconSpec], camera: CameraSpec, step: Nanos
    ) -> None:
        self._reference, self._beacons = reference, beacons
        self._pan, self._step, self._around = camera.pan, step, around(camera)

    def at(self, k: int) -> Exposure:
        t = k * self._step + self._step // 2
        return Exposure(t, tuple(self._moment(max(t + dt, 0)) for dt in self._around))

    def _moment(self, t: Nanos) -> Moment:
        pose = self._reference.at(t).pose
        return Moment(t, pose, self._angle(t, pose))

    def _angle(self, t: Nanos, pose: Pose) -> float:
        if self._pan.kind != "tracking":
            return make_pan(self._pan, []).turn(t)
        which = self._pan.beacon
        followed = self._beacons if which is None else self._beacons[which : which + 1]
        ways = [(beacon.at[0] - pose.x, beacon.at[1] - pose.y) for beacon in followed]
        dx, dy = min(ways, key=lambda way: hypot(*way), default=(cos(pose.yaw), sin(pose.yaw)))
        return wrap(atan2(dy, dx) - pose.yaw)


class Anywhere:
    """Each frame sees one beacon, drawn by lot, from a distance and under an azimuth drawn by lot.

    distance: m, from and to. Without a beacon the robot stands at the origin and looks anywhere. It moves at
    a speed and a yaw rate drawn by lot, and the pan axis turns: what is exposed for long is blurred.
    """

    def __init__(
        self, seed: int, beacons: Sequence[BeaconSpec], camera: CameraSpec, distance: tuple[float, float]
    ) -> None:
        self._seed, self._beacons = seed, beacons
        self._camera, self._distance = camera, distance
        self._pan = camera.pan.angle
        self._rate = camera.pan.rate if camera.pan.kind == "scanning" else 0.0
        self._step, self._around = nanos(1.0 / camera.rate), around(camera)

    def at(self, k: int) -> Exposure:
        random = rng.stream(self._seed, f"frames.{k}")
        pose, t = self._pose(random), (k + 1) * self._step
        v, w = random.uniform(*SPEEDS), random.uniform(*YAW_RATES)
        return Exposure(t, tuple(self._moment(pose, (v, w), t, dt) for dt in self._around))

    def _moment(self, pose: Pose, speeds: tuple[float, float], t: Nanos, dt: Nanos) -> Moment:
        v, w = (speed * seconds(dt) for speed in speeds)
        return Moment(t + dt, moved(pose, v, w), self._pan + self._rate * seconds(dt))

    def _pose(self, random: Rng) -> Pose:
        if not self._beacons:
            return Pose(0.0, 0.0, wrap(random.uniform(-pi, pi)))
        for _ in range(TRIES):
            pose = self._one(random)
            if all(hypot(pose.x - x, pose.y - y) > CLEARANCE for x, y in (b.at for b in self._beacons)):
                return pose
        return pose

    def _one(self, random: Rng) -> Pose:
        """Returns a pose from which the optical centre sees the beacon."""
        x, y = self._beacons[int(random.integers(len(self._beacons)))].at
        distance, bearing = random.uniform(*self._distance), random.uniform(-pi, pi)
        aside = random.uniform(-0.5, 0.5) * self._camera.lens.fov
        look = bearing + pi - aside
        yaw = wrap(look - self._pan)
        forward, left = self._camera.mount[:2]
        c, s = cos(yaw), sin(yaw)
        centre = x + distance * cos(bearing), y + distance * sin(bearing)
        return Pose(centre[0] - c * forward + s * left, centre[1] - s * forward - c * left, yaw)
