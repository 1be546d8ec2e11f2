"""A bench around simulated drives: wire, firmware, motors, world and sensors on one clock."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import replace
from functools import partial
from typing import NamedTuple

from hilbed.build import elsewhere
from hilbed.build.axes import Workshop
from hilbed.build.bench import Bench
from hilbed.build.carriage import join
from hilbed.build.hands import Hands
from hilbed.build.known import boot_of, nodes_of, start_of, surroundings, told_of
from hilbed.build.minds import Guidance, make_controller, make_estimator
from hilbed.build.senses import Scene, kinds_of, make_sensors
from hilbed.build.upsets import effects_of, schedule_of
from hilbed.can.base import CanBase
from hilbed.can.faults import Faults
from hilbed.can.master import Master
from hilbed.can.traffic import CONTROLLER
from hilbed.can.wire import Wire
from hilbed.clock import nanos
from hilbed.cost import Cost
from hilbed.disturbances.commands import DisturbedBase
from hilbed.effects import Effects
from hilbed.loop import Rig
from hilbed.pacer import Pacer
from hilbed.plant.axes import Axis
from hilbed.plant.bullet import BulletWorld
from hilbed.plant.bullet_tricycle import TricycleWorld
from hilbed.plant.simulated import SimulatedPlant
from hilbed.plant.specs import STEERING, SimulatedSpec
from hilbed.plant.supply import Supply
from hilbed.plant.urdf import Behind, moved_inertia
from hilbed.ports import Witness
from hilbed.robots import ROBOTS
from hilbed.robots.limited import Limited
from hilbed.scenario import files
from hilbed.scenario.bodies import body_of
from hilbed.scenario.load import Loaded
from hilbed.types import Nanos


def simulated(
    loaded: Loaded, witness: Witness, cost: Cost, separate: bool, pacer: Pacer | None = None
) -> Bench:
    """Returns the whole bench, in simulated time or, with a pacer, in real time.

    Raises ScenarioError where URDF, renderer or bus refuse.
    """
    with ExitStack() as closing:
        bench = _bench(loaded, _Means(witness, cost, separate, pacer), closing)
        close = closing.pop_all().close
    return replace(bench, close=close)


class _Means(NamedTuple):
    """What a bench is given: who hears, what it costs, cameras in processes of their own, the wall clock."""

    witness: Witness
    cost: Cost
    separate: bool
    pacer: Pacer | None


def _bench(loaded: Loaded, means: _Means, closing: ExitStack) -> Bench:
    """Builds everything; what has to be given back is left in `closing`."""
    witness, cost, separate, pacer = means
    scenario, spec = loaded.scenario, loaded.scenario.plant
    assert isinstance(spec, SimulatedSpec)
    robot = ROBOTS[scenario.robot.kind](scenario.robot)
    reference = None if scenario.reference is None else scenario.reference.build()
    start, period, tick = start_of(scenario, reference), nanos(scenario.period), nanos(spec.tick)
    told = told_of(scenario, start)
    nodes = nodes_of(scenario, spec, robot.drives)

    body = body_of(scenario.robot, files.resolve(scenario.robot.urdf, loaded.folder))
    effects = Effects([spec.friction] * len(body.treads), len(robot.drives))
    schedule = schedule_of(scenario, robot.drives, effects)
    scene = Scene(spec.beacons, effects, witness, cost, separate, spec.scenery)
    sensors = make_sensors(scenario, scene, closing)
    inertia = Behind(spec.machine(robot.drives[0]).inertia, spec.machine(STEERING).inertia)
    world = WORLDS[scenario.robot.kind](body, spec, start, inertia, cost)
    closing.callback(world.close)
    if spec.steering is not None:
        world.turn(robot.drives.index(STEERING), spec.steering.start)
    faults = Faults()
    wire = Wire(scenario.bus.bitrate, witness.transfer, faults.note)
    faults.join(wire)
    port = wire.attach(CONTROLLER, strict=True)
    carriage = join(wire, scenario.bus, nodes, pacer, closing)
    elsewhere.check(nodes, carriage, scenario.terminal)
    terminals = elsewhere.terminals_of(nodes, carriage, scenario.terminal, closing)
    moved = dict(zip(robot.drives, moved_inertia(body, inertia), strict=True))
    axes = Workshop(spec, moved, wire, terminals).axes(nodes)
    schedule.listeners += [faults.update, partial(_power, axes)]
    supply, collect = Supply(spec.supply), None if terminals is None else terminals.collect
    plant = SimulatedPlant(axes, world, supply, schedule, carriage.medium, sensors, tick, cost, collect)
    base = CanBase(Limited(robot, [node.max_speed for node in nodes]), port, nodes, scenario.bus)
    rig = Rig(
        DisturbedBase(base, robot.limited, effects_of(schedule, world)),
        sensors,
        make_estimator(scenario.estimator, surroundings(scenario, spec.beacons, told)),
        make_controller(scenario.controller, Guidance(reference, period, robot)),
        plant,
        period,
        cost,
    )

    flush = [sensor.flush for sensor in sensors]
    wake = elsewhere.wakers(nodes, carriage, terminals)
    master, power_on = Master(nodes, port, period), boot_of(scenario)
    searching = any(node.searches for node in nodes)
    hands = Hands(master, base, plant, carriage, flush, tick, period, wake, faults, power_on, searching)
    return Bench(
        rig, told, reference, robot.drives, kinds_of(scenario), tuple(spec.beacons), tick,
        hands.boot, hands.stop, plant.ticks, hands.events, closing.close, nodes,
        carriage.due, lambda: elsewhere.late(base.late, terminals),
        lambda: {"nodes": {node.name: node.kind for node in nodes}, **carriage.account()}, power_on,
    )  # fmt: skip


def _power(axes: Sequence[Axis], t: Nanos, effects: Effects) -> None:
    """Takes the drives' logic its supply or gives it back."""
    for axis in axes:
        axis.power(t, axis.name not in effects.unpowered)


WORLDS = {"diffdrive": BulletWorld, "tricycle": TricycleWorld}
