"""A camera's eye: from the robot's pose to an image, what is found in it, and what that truly is."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import cos, nan, sin
from typing import NamedTuple, Protocol, TypeAlias

from hilbed.cost import Cost, perf_counter
from hilbed.scene import BeaconSpec
from hilbed.types import Image, Pose
from hilbed.vision.seams import Detection, Detector, Renderer
from hilbed.vision.truth import SPURIOUS, match, sights

Mount = tuple[float, float, float]


class Finding(NamedTuple):
    """A detection, the beacon it truly shows and that one's azimuth (rad, robot's frame); −1, NaN: none."""

    detection: Detection
    beacon: int
    azimuth: float


class Glimpse(NamedTuple):
    """One exposed frame: image (H, W, 3) RGB and what was found in it, from left to right."""

    image: Image
    findings: list[Finding]


Ticket: TypeAlias = Callable[[], Glimpse]
"""Gives the frame that was asked for; to be called once, waits where the frame is not ready yet."""


class Eye(Protocol):
    """Exposes frames one at a time: each ticket is used before the next look.

    beacons: those it knows; cost: where it adds its time, rendering and the rest.
    """

    beacons: tuple[BeaconSpec, ...]
    cost: Cost

    def look(self, pose: Pose, pan: float) -> Ticket:
        """Exposes a frame from the robot's pose with the camera turned by `pan` (rad, robot's frame)."""
        ...

    def close(self) -> None:
        """Gives back what the eye holds."""
        ...


class LocalEye:
    """Renders what is seen from the mount (m, robot's frame) and runs the detector on it, at once.

    beacons: those that renderer and detector know; cost: the renderer's.
    """

    def __init__(
        self, mount: Mount, beacons: Sequence[BeaconSpec], renderer: Renderer, detector: Detector, cost: Cost
    ) -> None:
        self.beacons = tuple(beacons)
        self.cost = cost
        self._mount = mount
        self._renderer = renderer
        self._detector = detector

    def look(self, pose: Pose, pan: float) -> Ticket:
        """Exposes a frame from the robot's pose with the camera turned by `pan` (rad, robot's frame)."""
        cost = self.cost
        start, rendered = perf_counter(), cost.render
        forward, left, height = self._mount
        c, s = cos(pose.yaw), sin(pose.yaw)
        x, y = pose.x + c * forward - s * left, pose.y + s * forward + c * left
        image = self._renderer.render(x, y, height, pose.yaw + pan)
        glimpse = Glimpse(image, self._findings(image, Pose(x, y, pose.yaw), pan))
        cost.vision += perf_counter() - start - (cost.render - rendered)
        return lambda: glimpse

    def close(self) -> None:
        """Gives back what the renderer holds."""
        self._renderer.close()

    def _findings(self, image: Image, centre: Pose, pan: float) -> list[Finding]:
        """Returns what the detector finds, beside the truth as seen from the optical centre."""
        seen = sights(self.beacons, *centre)
        found = []
        for detection in self._detector.detect(image):
            beacon = match(pan + detection.azimuth, seen)
            azimuth = nan if beacon == SPURIOUS else seen[beacon].azimuth
            found.append(Finding(detection, beacon, azimuth))
        return found
