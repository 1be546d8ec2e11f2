"""Direct sensors for the tests, with all that they are handed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import TypeAdapter

from hilbed.build.senses import SENSORS, Scene
from hilbed.cost import Cost
from hilbed.effects import Effects
from hilbed.rng import stream
from hilbed.scene import BeaconSpec
from hilbed.sensors import BearingSpec, PositionSpec, RangeBearingSpec
from hilbed.sensors.direct import Post
from hilbed.types import Pose, Reading, Snapshot, Transfer, Truth

BEACONS = tuple(BeaconSpec(at=at) for at in ((4.0, 0.0), (0.0, 2.0), (-3.0, -4.0)))
NAME = "mine"
SPEC: TypeAdapter[Any] = TypeAdapter(PositionSpec | BearingSpec | RangeBearingSpec)


class Ear:
    """A witness that remembers readings with the truth behind them."""

    def __init__(self) -> None:
        self.heard: list[tuple[Reading, int, tuple[float, ...]]] = []

    def reading(self, reading: Reading, beacon: int, true: tuple[float, ...]) -> None:
        self.heard.append((reading, beacon, true))

    def snapshot(self, snapshot: Snapshot) -> None:
        raise AssertionError(f"no camera, but it has exposed {snapshot}")

    def transfer(self, transfer: Transfer) -> None:
        raise AssertionError(f"not on the bus, but it has sent {transfer}")


class Rig:
    """A sensor of a scenario's block, on a robot that stands at `pose` while it samples."""

    def __init__(
        self, block: Mapping[str, Any], beacons: tuple[BeaconSpec, ...] = BEACONS, seed: int = 1
    ) -> None:
        self.spec = SPEC.validate_python(block)
        self.ear, self.effects = Ear(), Effects(())
        post = Post(NAME, stream(seed, f"sensors.{NAME}"), self.effects, self.ear)
        self.sensor = SENSORS[self.spec.kind](self.spec, post, Scene(beacons, self.effects, self.ear, Cost()))

    def sampled(self, pose: Pose, count: int = 1) -> list[Reading]:
        """Samples as often as asked and returns all the readings."""
        for _ in range(count):
            self.sensor.sample(Truth(self.sensor.due, pose))
        return self.sensor.read(2**62)
