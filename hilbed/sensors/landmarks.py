"""Sensors of landmarks: bearings, or ranges and bearings, with identities known."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import cos, inf, pi, sin
from typing import Annotated, Literal

from pydantic import Field

from hilbed.scene import BeaconSpec
from hilbed.sensors.direct import DirectSpec, Look, Quantity
from hilbed.spec import NonNegative, Point, Positive
from hilbed.types import Pose
from hilbed.vision.truth import Sight, sights

TOUCHING = 1e-3
"""m; a landmark that is nearer is in no direction, and not reported."""


class LandmarkSpec(DirectSpec):
    """What sees landmarks all round; mount: m, robot's frame; max_range: m, null for any."""

    mount: Point = (0.0, 0.0)
    max_range: Positive | None = None


class BearingSpec(LandmarkSpec):
    """Bearings of the beacons as a camera that never errs would see them; noise: rad, standard deviation."""

    kind: Literal["bearing"] = "bearing"
    noise: Annotated[NonNegative, Field(le=pi)] = 0.0

    def kinds(self) -> dict[str, int]:
        """Returns what it measures, with the number of components."""
        return {"azimuth": 1}


class RangeBearingSpec(LandmarkSpec):
    """Range and bearing of each landmark, as in Bui & Duong (2022), eq. (4.6).

    range_noise (m), bearing_noise (rad): standard deviations, free in the paper. No range is negative.
    """

    kind: Literal["range_bearing"] = "range_bearing"
    range_noise: NonNegative = 0.1
    bearing_noise: Annotated[NonNegative, Field(le=pi)] = 0.02

    def kinds(self) -> dict[str, int]:
        """Returns what it measures, with the number of components."""
        return {"range": 1, "azimuth": 1}


def bearing(spec: BearingSpec, beacons: Sequence[BeaconSpec]) -> Look:
    """Returns what there is to be read from a pose."""
    return Landmarks(spec, beacons, lambda k, sight: [_azimuth(k, sight, spec.noise)])


def range_bearing(spec: RangeBearingSpec, beacons: Sequence[BeaconSpec]) -> Look:
    """Returns what there is to be read from a pose: of each landmark its range, then its bearing."""

    def read(k: int, sight: Sight) -> list[Quantity]:
        reach = Quantity("range", (sight.distance,), (spec.range_noise,), k, k)
        return [reach, _azimuth(k, sight, spec.bearing_noise)]

    return Landmarks(spec, beacons, read)


class Landmarks:
    """What there is to be read of the landmarks that are neither out of range nor touched.

    `touching` counts those that would have been read, but that the sensor stood on.
    """

    def __init__(
        self, spec: LandmarkSpec, beacons: Sequence[BeaconSpec], read: Callable[[int, Sight], list[Quantity]]
    ) -> None:
        """read: quantities of a landmark, from its index and its sight."""
        self._mount = spec.mount
        self._farthest = inf if spec.max_range is None else spec.max_range
        self._beacons = beacons
        self._read = read
        self.touching = 0

    def counts(self) -> dict[str, float]:
        """Returns how often the sensor stood on a landmark."""
        return {"touching": self.touching}

    def __call__(self, pose: Pose) -> list[Quantity]:
        """Reads from a pose of the robot, in the order of the landmarks."""
        forward, left = self._mount
        c, s = cos(pose.yaw), sin(pose.yaw)
        x, y = pose.x + c * forward - s * left, pose.y + s * forward + c * left
        found: list[Quantity] = []
        for k, sight in enumerate(sights(self._beacons, x, y, pose.yaw)):
            self.touching += sight.distance < TOUCHING
            if TOUCHING <= sight.distance <= self._farthest:
                found += self._read(k, sight)
        return found


def _azimuth(k: int, sight: Sight, std: float) -> Quantity:
    return Quantity("azimuth", (sight.azimuth,), (std,), k, k)
