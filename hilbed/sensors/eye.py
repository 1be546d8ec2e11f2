"""A camera's eye: from the robot's pose to an image, what is found in it, and what that truly is."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import nan
from typing import TYPE_CHECKING, NamedTuple, Protocol, TypeAlias

from hilbed.cost import Cost, perf_counter
from hilbed.scene import BeaconSpec, ScenerySpec
from hilbed.sensors.exposure import Exposure
from hilbed.types import Image, Pose
from hilbed.vision.seams import (
    Closing,
    Detection,
    DetectionFailed,
    Detector,
    Shot,
    Talking,
    Trouble,
)
from hilbed.vision.truth import SPURIOUS, match, sights

if TYPE_CHECKING:
    from hilbed.sensors.imager import Imager


class Setting(NamedTuple):
    """What a camera is put in front of, and whose noise it has: the run's seed and the camera's own name."""

    beacons: tuple[BeaconSpec, ...]
    scenery: ScenerySpec = ScenerySpec()
    seed: int = 0
    name: str = "camera"


class Finding(NamedTuple):
    """A detection, the beacon it truly shows and that one's azimuth (rad, robot's frame); −1, NaN: none."""

    detection: Detection
    beacon: int
    azimuth: float


class Glimpse(NamedTuple):
    """One exposed frame: image (H, W, 3) RGB and what was found in it, from left to right.

    trouble: why there is no answer of the detector, if there is none; said: what it printed meanwhile.
    """

    image: Image
    findings: list[Finding]
    trouble: Trouble | None = None
    said: str = ""


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
    """Exposes a frame and runs the detector on it, at once; cost: the renderer's."""

    def __init__(self, imager: Imager, beacons: Sequence[BeaconSpec], detector: Detector, cost: Cost) -> None:
        self.beacons = tuple(beacons)
        self.cost = cost
        self._imager, self._detector = imager, detector
        self._talking = detector if isinstance(detector, Talking) else None

    def look(self, exposure: Exposure) -> Ticket:
        """Exposes a frame."""
        cost = self.cost
        start, rendered = perf_counter(), cost.render
        shot = self._imager.shoot(exposure)
        moment = exposure.at(exposure.t)
        view = self._imager.viewpoint(moment)
        glimpse = self._judged(shot, Pose(view.x, view.y, moment.pose.yaw), moment.pan)
        cost.vision += perf_counter() - start - (cost.render - rendered)
        return lambda: glimpse

    def close(self) -> None:
        """Gives back what renderer and detector hold."""
        self._imager.close()
        if isinstance(self._detector, Closing):
            self._detector.close()

    def _judged(self, shot: Shot, centre: Pose, pan: float) -> Glimpse:
        """Returns a frame with what is found in it; without an answer of the detector, that is nothing."""
        try:
            findings = self._findings(shot, centre, pan)
        except DetectionFailed as failed:
            return Glimpse(shot.image, [], failed.trouble, failed.trouble.said)
        return Glimpse(shot.image, findings, said=self._talking.said if self._talking else "")

    def _findings(self, shot: Shot, centre: Pose, pan: float) -> list[Finding]:
        """Returns what the detector finds, beside the truth as seen from the optical centre."""
        seen = sights(self.beacons, *centre)
        found = []
        for detection in self._detector.detect(shot):
            beacon = match(pan + detection.azimuth, seen)
            azimuth = nan if beacon == SPURIOUS else seen[beacon].azimuth
            found.append(Finding(detection, beacon, azimuth))
        return found
