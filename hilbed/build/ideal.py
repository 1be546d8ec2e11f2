"""A bench around an ideal robot: a kinematic plant that is told commands directly, as in the papers."""

from __future__ import annotations

from contextlib import ExitStack

from hilbed import rng
from hilbed.build.bench import Bench
from hilbed.build.known import start_of, surroundings, told_of
from hilbed.build.minds import Guidance, make_controller, make_estimator
from hilbed.build.senses import Scene, kinds_of, make_sensors
from hilbed.build.upsets import Nowhere, schedule_of
from hilbed.clock import nanos
from hilbed.cost import Cost
from hilbed.effects import Effects
from hilbed.loop import Rig, at_once
from hilbed.pacer import Pacer
from hilbed.plant.kinematic import IdealBase, KinematicPlant
from hilbed.plant.kinematic_spec import KinematicSpec, make_vehicle
from hilbed.ports import Witness
from hilbed.robots import ROBOTS
from hilbed.scenario.load import Loaded


def ideal(loaded: Loaded, witness: Witness, cost: Cost, separate: bool, pacer: Pacer | None) -> Bench:
    """Returns a bench without drives and bus; raises ScenarioError where a renderer refuses."""
    scenario, spec = loaded.scenario, loaded.scenario.plant
    assert isinstance(spec, KinematicSpec)
    robot = ROBOTS[scenario.robot.kind](scenario.robot)
    reference = None if scenario.reference is None else scenario.reference.build()
    start, period = start_of(scenario, reference), nanos(scenario.period)
    vehicle = make_vehicle(spec, robot.twist, robot.limited, rng.stream(scenario.seed, "plant"))
    effects = Effects(())
    schedule = schedule_of(scenario, (), effects)
    with ExitStack() as closing:
        scene = Scene(spec.beacons, effects, witness, cost, separate, spec.scenery)
        sensors = make_sensors(scenario, scene, closing)
        close = closing.pop_all().close
    plant = KinematicPlant(start, vehicle, sensors, lambda t: schedule.apply(t, Nowhere()))
    told = told_of(scenario, start)
    rig = Rig(
        IdealBase(plant, vehicle),
        sensors,
        make_estimator(scenario.estimator, surroundings(scenario, spec.beacons, told)),
        make_controller(scenario.controller, Guidance(reference, period, robot)),
        plant,
        period,
        cost,
    )
    pace = at_once if pacer is None else pacer.due
    return Bench(
        rig, told, reference, (), kinds_of(scenario), tuple(spec.beacons),
        boot=lambda _: plant.start(), close=close, pace=pace,
    )  # fmt: skip
