"""A camera's eye: from the robot's pose to an image, what is found in it, and where things really are."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, sin
from typing import NamedTuple

from hilbed.cost import Cost
from hilbed.scene import BeaconSpec
from hilbed.types import Pose
from hilbed.vision.seams import Detection, Detector, Image, Renderer
from hilbed.vision.truth import Sight, sights

Mount = tuple[float, float, float]


class Glimpse(NamedTuple):
    """One exposed frame: image (H, W, 3) RGB, what was found in it, and the truth in the robot's frame."""

    image: Image
    detections: list[Detection]
    truth: list[Sight]


class Eye:
    """Renders what is seen from the mount (m, robot's frame) and runs the detector on it.

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

    def look(self, pose: Pose, pan: float) -> Glimpse:
        """Exposes a frame from the robot's pose with the camera turned by `pan` (rad, robot's frame)."""
        forward, left, height = self._mount
        c, s = cos(pose.yaw), sin(pose.yaw)
        x, y = pose.x + c * forward - s * left, pose.y + s * forward + c * left
        image = self._renderer.render(x, y, height, pose.yaw + pan)
        return Glimpse(image, self._detector.detect(image), sights(self.beacons, x, y, pose.yaw))

    def close(self) -> None:
        """Gives back what the renderer holds."""
        self._renderer.close()
