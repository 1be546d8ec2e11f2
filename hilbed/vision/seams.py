"""What may be exchanged between the world and a detection: who makes the image, who finds beacons in it."""

from __future__ import annotations

from typing import NamedTuple, Protocol

from hilbed.types import Image


class Detection(NamedTuple):
    """One beacon found in an image.

    azimuth: rad in the camera's frame, left positive; std: of the azimuth, rad; column: pixels, on the
    horizon; beacon: index in the scenario's list of beacons, None where the identity is unknown.
    """

    azimuth: float
    std: float
    column: float
    beacon: int | None


class Renderer(Protocol):
    """Makes the image that a level camera sees."""

    def render(self, x: float, y: float, z: float, yaw: float) -> Image:
        """Returns (H, W, 3) RGB as seen from x, y, z (m, map) along `yaw` (rad, map)."""
        ...

    def close(self) -> None: ...


class Detector(Protocol):
    """Finds beacons in an image and knows nothing else."""

    def detect(self, image: Image) -> list[Detection]:
        """Returns what is seen in an (H, W, 3) RGB image, from left to right."""
        ...
