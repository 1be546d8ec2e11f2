"""What stands in the arena: beacons, and all that a camera sees besides."""

from hilbed.scene.beacons import MOST_BEACONS, BeaconSpec, FlashSpec
from hilbed.scene.colours import COLOURS, Colour
from hilbed.scene.scenery import (
    Corner,
    FloorSpec,
    LightSpec,
    ObjectSpec,
    RandomSpec,
    SceneryBlock,
    ScenerySpec,
    WallsSpec,
)

__all__ = [
    "COLOURS", "MOST_BEACONS", "BeaconSpec", "Colour", "Corner", "FlashSpec", "FloorSpec", "LightSpec",
    "ObjectSpec", "RandomSpec", "SceneryBlock", "ScenerySpec", "WallsSpec",
]  # fmt: skip
