"""Where the robot stands, and how its camera is turned, in each frame of a dataset."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, cos, hypot, pi, sin
from typing import NamedTuple, Protocol

from hilbed import rng
from hilbed.angles import wrap
from hilbed.clock import nanos
from hilbed.control.reference import PathReference
from hilbed.scene import BeaconSpec
from hilbed.sensors import CameraSpec
from hilbed.sensors.pan import make_pan
from hilbed.types import Nanos, Pose, Rng

CLEARANCE = 0.3  # m from any beacon's axis: the camera is never inside one
TRIES = 100


class Stand(NamedTuple):
    """One frame's time, robot's pose and pan angle (rad, robot's frame)."""

    t: Nanos
    body: Pose
    pan: float


class Poses(Protocol):
    def at(self, k: int) -> Stand:
        """Returns where frame k is taken, the same in whatever order they are asked for."""
        ...


class AlongPath:
    """On the reference, `step` apart in time; an axis that tracks a beacon looks right at it."""

    def __init__(
        self, reference: PathReference, beacons: Sequence[BeaconSpec], camera: CameraSpec, step: Nanos
    ) -> None:
        self._reference, self._beacons = reference, beacons
        self._pan, self._step = camera.pan, step

    def at(self, k: int) -> Stand:
        t = k * self._step
        pose = self._reference.at(t).pose
        return Stand(t, pose, self._angle(t, pose))

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

    distance: m, from and to. Without a beacon the robot stands at the origin and looks anywhere.
    """

    def __init__(
        self, seed: int, beacons: Sequence[BeaconSpec], camera: CameraSpec, distance: tuple[float, float]
    ) -> None:
        self._seed, self._beacons = seed, beacons
        self._camera, self._distance = camera, distance
        self._pan = camera.pan.angle
        self._step = nanos(1.0 / camera.rate)

    def at(self, k: int) -> Stand:
        random = rng.stream(self._seed, f"frames.{k}")
        return Stand(k * self._step, self._pose(random), self._pan)

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
