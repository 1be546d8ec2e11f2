"""Cameras for the tests: a witness that remembers, and an eye that sees what the test tells it."""

from __future__ import annotations

from collections.abc import Mapping
from math import atan2, hypot
from typing import Any

import numpy as np

from hilbed.angles import wrap
from hilbed.cost import Cost
from hilbed.effects import Effects
from hilbed.rng import stream
from hilbed.scene import BeaconSpec
from hilbed.sensors.camera import Camera, CameraSpec, open_eye
from hilbed.sensors.eye import LocalEye, Setting
from hilbed.sensors.imager import Imager, Place
from hilbed.types import Image, Nanos, Pose, Reading, Snapshot, Transfer, Truth
from hilbed.vision.seams import Detection, Shot, Viewpoint

ORIGIN = Pose(0.0, 0.0, 0.0)
EXPOSURE: Nanos = 100_000_000
BEACONS = tuple(
    BeaconSpec(at=at, colour=colour)
    for at, colour in (
        ((4.0, 0.0), "red"),
        ((0.0, 4.0), "green"),
        ((-4.0, 0.0), "blue"),
        ((0.0, -4.0), "yellow"),
    )
)


class Notes:
    """A witness that remembers."""

    def __init__(self) -> None:
        self.readings: list[tuple[Reading, int, float]] = []
        self.snapshots: list[Snapshot] = []

    def reading(self, reading: Reading, beacon: int, true: tuple[float, ...]) -> None:
        self.readings.append((reading, beacon, *true))

    def snapshot(self, snapshot: Snapshot) -> None:
        self.snapshots.append(snapshot)

    def transfer(self, transfer: Transfer) -> None:
        raise AssertionError(f"a camera is not on the bus, but sent {transfer}")


class Ideal:
    """Renderer and detector in one, without an image: sees beacons exactly where they are."""

    def __init__(self, spec: CameraSpec, beacons: tuple[BeaconSpec, ...]) -> None:
        self._half, self._beacons = 0.5 * spec.lens.fov, beacons
        self.eye = Viewpoint(0.0, 0.0, 0.0, 0.0)
        self.frames = 0
        self.seen: list[Viewpoint] = []

    def render(self, view: Viewpoint, t: Nanos) -> Image:  # noqa: ARG002
        self.eye = view
        self.frames += 1
        self.seen.append(view)
        return np.zeros((64, 640, 3), np.uint8)

    def detect(self, shot: Shot) -> list[Detection]:  # noqa: ARG002
        x, y, _, yaw, *_ = self.eye
        seen = []
        for k, beacon in enumerate(self._beacons):
            azimuth = wrap(atan2(beacon.at[1] - y, beacon.at[0] - x) - yaw)
            if abs(azimuth) < self._half and hypot(beacon.at[0] - x, beacon.at[1] - y) > 0.1:
                seen.append(Detection(azimuth, 1e-5, 320.0 - 100.0 * azimuth, k))
        return sorted(seen, key=lambda detection: detection.column)

    def labels(self, view: Viewpoint, t: Nanos) -> Image:  # noqa: ARG002
        return np.zeros((64, 640), np.uint8)

    def close(self) -> None:
        pass


class Bench:
    """A camera with all that it is handed, on a robot that stands at `pose` while it exposes."""

    def __init__(
        self,
        block: Mapping[str, Any],
        beacons: tuple[BeaconSpec, ...] = BEACONS,
        rendered: bool = False,
        seed: int = 1,
    ) -> None:
        spec = CameraSpec.model_validate(block)
        self.notes, self.effects, self.cost = Notes(), Effects([1.0, 1.0]), Cost()
        self.ideal = Ideal(spec, beacons)
        ideal = LocalEye(Imager(Place(spec.mount, spec.lens), self.ideal), beacons, self.ideal, self.cost)
        eye = open_eye(spec, Setting(beacons), self.cost) if rendered else ideal
        self.camera = Camera(spec, eye, stream(seed, "camera"), self.effects, self.notes)

    def expose(self, frames: int, pose: Pose = ORIGIN) -> list[Reading]:
        """Exposes frames as they are due and returns all their readings."""
        for _ in range(frames):
            self.camera.sample(Truth(self.camera.due, pose))
        return self.camera.read(self.camera.due + 10 * EXPOSURE)

    @property
    def pans(self) -> list[float]:
        return [snapshot.pan for snapshot in self.notes.snapshots]
