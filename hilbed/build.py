"""From a scenario to a bench: the only module that knows every concrete class."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from hilbed import rng
from hilbed.clock import MILLISECOND, SECOND, nanos
from hilbed.control.reference import PathReference
from hilbed.cost import Cost
from hilbed.disturbances import DISTURBANCES
from hilbed.disturbances.schedule import Schedule
from hilbed.effects import Effects
from hilbed.loop import Rig
from hilbed.plant.recorded_spec import RecordedSpec
from hilbed.plant.specs import SimulatedSpec
from hilbed.ports import Controller, Estimator, Plant, Robot, Sensor, Witness
from hilbed.robots import ROBOTS
from hilbed.scenario import files
from hilbed.scenario.load import Loaded
from hilbed.scenario.model import Scenario
from hilbed.types import Array, Nanos, Pose

BOOT: Nanos = SECOND
"""How long before t = 0 the drives are powered; time stamps in can.log and log.mcap are t plus this."""

STANDSTILL: Nanos = 500 * MILLISECOND
"""How long the drives are watched after the last cycle, while they stop."""


@dataclass(frozen=True)
class Bench:
    """A rig and what is done with it before and after its cycles; tick in ns.

    boot: brings the drives up, ends at t = 0; stop: brings them to rest from the time given;
    ticks: the plant's log from a row on; warnings: what the drives did that they should not have.
    """

    rig: Rig
    tick: Nanos = MILLISECOND
    boot: Callable[[], None] = lambda: None
    stop: Callable[[Nanos], None] = lambda _: None
    ticks: Callable[[int], dict[str, Array]] = lambda _: {}
    events: Callable[[], list[str]] = list
    close: Callable[[], None] = lambda: None


def reference_of(scenario: Scenario) -> PathReference | None:
    """Returns the scenario's reference path, if it has one."""
    return None if scenario.reference is None else scenario.reference.build()


def start_of(scenario: Scenario) -> Pose:
    """Returns where the robot stands at t = 0."""
    if scenario.robot.start is not None:
        return Pose(*scenario.robot.start)
    reference = reference_of(scenario)
    return Pose(0.0, 0.0, 0.0) if reference is None else reference.at(0).pose


def build(loaded: Loaded, witness: Witness, cost: Cost) -> Bench:
    """Returns the bench of a scenario; raises ScenarioError for what only building it can find."""
    builder = BUILDERS[loaded.scenario.plant.kind]
    return builder(loaded, witness, cost)


def _build_recorded(loaded: Loaded, witness: Witness, cost: Cost) -> Bench:
    raise NotImplementedError


def _build_simulated(loaded: Loaded, witness: Witness, cost: Cost) -> Bench:
    from hilbed.can.base import CanBase
    from hilbed.can.master import Master
    from hilbed.can.specs import resolve
    from hilbed.can.wire import Wire
    from hilbed.plant.bullet import BulletWorld
    from hilbed.plant.simulated import SimulatedPlant

    scenario = loaded.scenario
    plant_spec = scenario.plant
    assert isinstance(plant_spec, SimulatedSpec)
    period, tick, start = nanos(scenario.period), nanos(plant_spec.tick), start_of(scenario)
    robot = ROBOTS[scenario.robot.kind](scenario.robot)
    nodes = resolve(scenario.nodes, robot.drives)
    wire = Wire(scenario.bus.bitrate, witness.transfer)
    controller_port = wire.attach("controller")
    effects = Effects([plant_spec.friction] * len(robot.drives))
    schedule = _schedule(scenario, robot, effects)
    world = _world(loaded, start, cost)
    sensors = tuple(_sensors(scenario, effects, witness, cost))
    axes = [_axis(node.name, node.id, plant_spec, wire) for node in nodes]
    supply = partial(terminal_voltage, plant_spec.supply)
    plant = SimulatedPlant(axes, world, supply, schedule, wire, sensors, tick, cost)
    base = CanBase(robot, controller_port, nodes, scenario.bus)
    rig = Rig(base, sensors, _estimator(scenario, start), _controller(scenario, period), plant, period, cost)

    def pump(t: Nanos) -> Nanos:
        plant.idle(t, t + tick)
        return t + tick

    def boot() -> None:
        Master(nodes, controller_port, period).boot(pump, -BOOT, 0)
        plant.start()

    def stop(t: Nanos) -> None:
        base.stop(t)
        plant.advance(t, t + STANDSTILL)

    return Bench(rig, tick, boot, stop, plant.ticks, close=world.close)


def _schedule(scenario: Scenario, robot: Robot, effects: Effects) -> Schedule:
    entries = []
    for spec in scenario.disturbances:
        drive = getattr(spec, "drive", None)
        wheel = robot.drives.index(drive) if drive is not None else -1
        entries.append((spec, DISTURBANCES[spec.kind](spec, wheel)))
    return Schedule(entries, effects)


def _world(loaded: Loaded, start: Pose, cost: Cost) -> BulletWorld:
    from hilbed.plant.bullet import BulletWorld
    from hilbed.plant.drivetrain import reflected_inertia
    from hilbed.plant.urdf import BODIES

    robot, plant = loaded.scenario.robot, loaded.scenario.plant
    body = diffdrive(files.resolve(robot.urdf, loaded.folder), robot.wheel_radius, robot.track)
    return BulletWorld(body, plant, start, reflected_inertia(plant.motor, plant.gear), cost)


def _axis(name: str, node: int, plant: SimulatedSpec, wire: Wire) -> Axis:
    dt = plant.tick
    train = DriveTrain(plant.motor, plant.gear, plant.chopper, dt)
    return Axis(name, node, train, Encoder(plant.encoder, dt), wire.attach)


def _sensors(scenario: Scenario, effects: Effects, witness: Witness, cost: Cost) -> Iterator[Sensor]:
    for name, spec in scenario.sensors.items():
        eye = open_eye(spec, scenario.plant.beacons, cost)
        yield Camera(spec, eye, rng.stream(scenario.seed, f"sensors.{name}"), effects, witness)


def _estimator(scenario: Scenario, start: Pose) -> Estimator:
    return ESTIMATORS[scenario.estimator.kind](scenario, start)


def _controller(scenario: Scenario, period: Nanos) -> Controller:
    return CONTROLLERS[scenario.controller.kind](...)
