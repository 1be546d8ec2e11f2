"""A camera's eye: from the robot's pose to an image, what is found in it, and what that truly is."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import cos, nan, sin
from typing import NamedTuple, Protocol, TypeAlias

from hilbed.cost import Cost, perf_counter
from hilbed.scene import BeaconSpec
from hilbed.sensors.exposure import Exposure, Moment
from hilbed.types import Image, Pose
from hilbed.vision.lens import Lens
from hilbed.vision.seams import (
    Closing,
    Detection,
    DetectionFailed,
    Detector,
    Renderer,
    Shot,
    Trouble,
    Viewpoint,
)
from hilbed.vision.truth import SPURIOUS, match, sights

Mount = tuple[float, float, float]


class Place(NamedTuple):
    """A camera on its robot: optical centre (m, robot's frame) and lens."""

    mount: Mount
    lens: Lens


class Finding(NamedTuple):
    """A detection, the beacon it truly shows and that one's azimuth (rad, robot's frame); −1, NaN: none."""

    detection: Detection
    beacon: int
    azimuth: float


class Glimpse(NamedTuple):
    """One exposed frame: image (H, W, 3) RGB and what was found in it, from left to right.

    trouble: why there is no answer of the detector, if there is none.
    """

    image: Image
    findings: list[Finding]
    trouble: Trouble | None = None


Ticket: TypeAlias = Callable[[], Glimpse]
"""Gives the frame that was asked for; to be called once, waits where the frame is not ready yet."""


class Eye(Protocol):
    """Exposes frames one at a time: each ticket is used before the next look.

    beacons: those it knows; cost: where it adds its time, rendering and the rest.
    """

    beacons: tuple[BeaconSpec, ...]
    cost: Cost

    def look(self, exposure: Exposure) -> Ticket:
        """Exposes a frame."""
        ...

    def close(self) -> None:
        """Gives back what the eye holds."""
        ...


class LocalEye:
    """Renders what is seen from its place and runs the detector on it, at once.

    beacons: those that renderer and detector know; cost: the renderer's.
    """

    def __init__(
        self, place: Place, beacons: Sequence[BeaconSpec], renderer: Renderer, detector: Detector, cost: Cost
    ) -> None:
        self.beacons = tuple(beacons)
        self.cost = cost
        self._mount, self._lens = place
        self._renderer = renderer
        self._detector = detector

    def look(self, exposure: Exposure) -> Ticket:
        """Exposes a frame."""
        cost = self.cost
        start, rendered = perf_counter(), cost.render
        moment = exposure.at(exposure.t)
        view = viewpoint(self._mount, moment)
        image = self._renderer.render(view, exposure.t)
        centre = Pose(view.x, view.y, moment.pose.yaw)
        shot = Shot(image, exposure.t, self._lens)
        glimpse = self._judged(shot, centre, moment.pan)
        cost.vision += perf_counter() - start - (cost.render - rendered)
        return lambda: glimpse

    def close(self) -> None:
        """Gives back what renderer and detector hold."""
        self._renderer.close()
        if isinstance(self._detector, Closing):
            self._detector.close()

    def _judged(self, shot: Shot, centre: Pose, pan: float) -> Glimpse:
        """Returns a frame with what is found in it; without an answer of the detector, that is nothing."""
        try:
            return Glimpse(shot.image, self._findings(shot, centre, pan))
        except DetectionFailed as failed:
            return Glimpse(shot.image, [], failed.trouble)

    def _findings(self, shot: Shot, centre: Pose, pan: float) -> list[Finding]:
        """Returns what the detector finds, beside the truth as seen from the optical centre."""
        seen = sights(self.beacons, *centre)
        found = []
        for detection in self._detector.detect(shot):
            beacon = match(pan + detection.azimuth, seen)
            azimuth = nan if beacon == SPURIOUS else seen[beacon].azimuth
            found.append(Finding(detection, beacon, azimuth))
        return found


def viewpoint(mount: Mount, moment: Moment) -> Viewpoint:
    """Returns where a camera on `mount` (m, robot's frame) is and looks."""
    forward, left, height = mount
    (x, y, yaw), pan = moment.pose, moment.pan
    c, s = cos(yaw), sin(yaw)
    return Viewpoint(x + c * forward - s * left, y + s * forward + c * left, height, yaw + pan)
