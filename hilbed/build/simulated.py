"""A bench around simulated drives: wire, firmware, motors, world and sensors on one clock."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass

from hilbed import rng
from hilbed.build.bench import BOOT, Bench
from hilbed.build.known import nodes_of, start_of, surroundings
from hilbed.build.minds import make_controller, make_estimator
from hilbed.can.base import CanBase
from hilbed.can.channels import lend
from hilbed.can.master import Master
from hilbed.can.node import Node
from hilbed.can.wire import Wire
from hilbed.clock import MILLISECOND, nanos, seconds
from hilbed.cost import Cost
from hilbed.disturbances import DISTURBANCES
from hilbed.disturbances.schedule import Schedule
from hilbed.effects import Effects
from hilbed.loop import Rig
from hilbed.plant.axes import Axis, SimulatedAxis
from hilbed.plant.bullet import BulletWorld
from hilbed.plant.drivetrain import DriveTrain, reflected_inertia
from hilbed.plant.encoder import Encoder
from hilbed.plant.simulated import SimulatedPlant
from hilbed.plant.specs import SimulatedSpec
from hilbed.plant.supply import Supply
from hilbed.plant.urdf import Body, diffdrive, moved_inertia
from hilbed.ports import Witness
from hilbed.robots import ROBOTS
from hilbed.scenario import files
from hilbed.scenario.load import Loaded
from hilbed.scenario.model import Scenario
from hilbed.sensors.camera import Camera, open_eye
from hilbed.sensors.eye import Eye
from hilbed.types import Nanos

STANDSTILL: Nanos = 500 * MILLISECOND
"""How long the bench goes on after the last cycle, so that the drives come to rest."""


def simulated(loaded: Loaded, witness: Witness, cost: Cost, separate: bool) -> Bench:
    """Returns the whole bench in simulated time; raises ScenarioError where URDF or renderer refuse."""
    scenario, spec = loaded.scenario, loaded.scenario.plant
    assert isinstance(spec, SimulatedSpec)
    robot = ROBOTS[scenario.robot.kind](scenario.robot)
    reference = None if scenario.reference is None else scenario.reference.build()
    start, period, tick = start_of(scenario, reference), nanos(scenario.period), nanos(spec.tick)
    nodes = nodes_of(scenario, spec, robot.drives)

    effects = Effects([spec.friction] * len(robot.drives))
    schedule = _schedule(scenario, robot.drives, effects)
    eyes = [open_eye(sensor, spec.beacons, cost, separate) for sensor in scenario.sensors.values()]
    sensors = _sensors(scenario, eyes, effects, witness)
    body = _body(loaded)
    inertia = reflected_inertia(spec.motor, spec.gear)
    world = BulletWorld(body, spec, start, inertia, cost)
    wire = Wire(scenario.bus.bitrate, witness.transfer)
    guests = ExitStack()
    if scenario.bus.channel is not None:
        guests.enter_context(lend(scenario.bus.channel, wire))
    port = wire.attach("controller")
    axes = [_axis(node, spec, moved_inertia(body, inertia), wire) for node in nodes]
    plant = SimulatedPlant(axes, world, Supply(spec.supply), schedule, wire, sensors, tick, cost)
    base = CanBase(robot, port, nodes, scenario.bus)
    rig = Rig(
        base,
        sensors,
        make_estimator(scenario.estimator, surroundings(scenario, spec, start)),
        make_controller(scenario.controller, reference, period),
        plant,
        period,
        cost,
    )

    hands = _Hands(Master(nodes, port, period), base, plant, sensors, tick)
    guests.callback(world.close)
    for sensor in sensors:
        guests.callback(sensor.close)
    kinds = {"azimuth": 1} if sensors else {}
    return Bench(
        rig, start, reference, robot.drives, kinds, tuple(spec.beacons), tick,
        hands.boot, hands.stop, plant.ticks, hands.events, guests.close, nodes,
    )  # fmt: skip


@dataclass(frozen=True)
class _Hands:
    """What is done with a simulated bench before its first cycle and after its last; tick in ns."""

    master: Master
    base: CanBase
    plant: SimulatedPlant
    sensors: tuple[Camera, ...]
    tick: Nanos

    def boot(self) -> None:
        self.master.boot(self._pump, -BOOT, 0)
        self.plant.start()

    def _pump(self, t: Nanos) -> Nanos:
        self.plant.idle(t, t + self.tick)
        return t + self.tick

    def stop(self, t: Nanos) -> None:
        self.base.stop(t)
        try:
            self.plant.advance(t, t + STANDSTILL)
        finally:
            for sensor in self.sensors:
                sensor.flush()

    def events(self) -> list[str]:
        return [f"t = {seconds(e.t):.3f} s: {e.drive}: {e.text}" for e in self.base.ears.events]


def _schedule(scenario: Scenario, drives: tuple[str, ...], effects: Effects) -> Schedule:
    entries = []
    for k, spec in enumerate(scenario.disturbances):
        drive = getattr(spec, "drive", None)
        wheel = -1 if drive is None else drives.index(drive)
        entries.append(
            (spec, DISTURBANCES[spec.kind](spec, wheel, rng.stream(scenario.seed, f"disturbances.{k}")))
        )
    return Schedule(entries, effects)


def _sensors(
    scenario: Scenario, eyes: Sequence[Eye], effects: Effects, witness: Witness
) -> tuple[Camera, ...]:
    return tuple(
        Camera(spec, eye, rng.stream(scenario.seed, f"sensors.{name}"), effects, witness)
        for (name, spec), eye in zip(scenario.sensors.items(), eyes, strict=True)
    )


def _body(loaded: Loaded) -> Body:
    robot = loaded.scenario.robot
    return diffdrive(files.resolve(robot.urdf, loaded.folder), robot.wheel_radius, robot.track)


def _axis(node: Node, spec: SimulatedSpec, inertia: float, wire: Wire) -> Axis:
    train = DriveTrain(spec.motor, spec.gear, spec.chopper, spec.tick, inertia)
    return SimulatedAxis(node.name, node.id, train, Encoder(spec.encoder, spec.tick), wire.attach)
