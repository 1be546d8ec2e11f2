"""Sensors by their kind, for any plant."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from typing import Any, NamedTuple, Protocol

from hilbed import rng
from hilbed.cost import Cost
from hilbed.effects import Effects
from hilbed.ports import Sensor, Witness
from hilbed.scenario.model import Scenario
from hilbed.scene import BeaconSpec, ScenerySpec
from hilbed.sensors.direct import Direct, Post
from hilbed.sensors.landmarks import bearing, range_bearing
from hilbed.sensors.position import position


class LiveSensor(Sensor, Protocol):
    """A sensor in a world: what is under way comes in with `flush`, what it holds goes with `close`."""

    def flush(self) -> None: ...

    def close(self) -> None: ...


class Scene(NamedTuple):
    """What sensors look at, and with what: beacons, disturbances, cameras in processes of their own."""

    beacons: Sequence[BeaconSpec]
    effects: Effects
    witness: Witness
    cost: Cost
    separate: bool = False
    scenery: ScenerySpec = ScenerySpec()


def make_sensors(scenario: Scenario, scene: Scene, closing: ExitStack) -> tuple[LiveSensor, ...]:
    """Returns the scenario's sensors in its order; `closing` gives back what they hold.

    Raises ScenarioError where a renderer refuses.
    """
    sensors = []
    for name, spec in scenario.sensors.items():
        noise = rng.stream(scenario.seed, f"sensors.{name}")
        post = Post(name, noise, scene.effects, scene.witness, scenario.seed)
        sensor = SENSORS[spec.kind](spec, post, scene)
        closing.callback(sensor.close)
        sensors.append(sensor)
    return tuple(sensors)


def kinds_of(scenario: Scenario) -> dict[str, int]:
    """Returns what the sensors measure, with the number of components."""
    found: dict[str, int] = {}
    for sensor in scenario.sensors.values():
        found |= sensor.kinds()
    return found


def _camera(spec: Any, post: Post, scene: Scene) -> LiveSensor:
    from hilbed.sensors.camera import Camera, open_eye
    from hilbed.sensors.eye import Setting

    setting = Setting(tuple(scene.beacons), scene.scenery, post.seed, post.name)
    eye = open_eye(spec, setting, scene.cost, scene.separate)
    return Camera(spec, eye, post.rng, post.effects, post.witness)


def _position(spec: Any, post: Post, _: Scene) -> LiveSensor:
    return Direct(spec, position(spec), post)


def _bearing(spec: Any, post: Post, scene: Scene) -> LiveSensor:
    return Direct(spec, bearing(spec, scene.beacons), post)


def _range_bearing(spec: Any, post: Post, scene: Scene) -> LiveSensor:
    return Direct(spec, range_bearing(spec, scene.beacons), post)


SENSORS: dict[str, Callable[[Any, Post, Scene], LiveSensor]] = {
    "camera": _camera, "position": _position, "bearing": _bearing, "range_bearing": _range_bearing,
}  # fmt: skip
