"""What stands in the arena: beacons, and all that a camera sees besides."""

from hilbed.scene.beacons import BeaconSpec, FlashSpec
from hilbed.scene.colours import COLOURS, Colour
from hilbed.scene.scenery import (
    FloorSpec,
    LightSpec,
    ObjectSpec,
    RandomSpec,
    SceneryBlock,
    ScenerySpec,
    WallsSpec,
)

__all__ = [
    "COLOURS", "BeaconSpec", "Colour", "FlashSpec", "FloorSpec", "LightSpec", "ObjectSpec", "RandomSpec",
    "SceneryBlock", "ScenerySpec", "WallsSpec",
]  # fmt: skip
