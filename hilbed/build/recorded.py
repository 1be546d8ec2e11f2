"""A bench around a recorded robot."""

from __future__ import annotations

from hilbed import rng
from hilbed.build.bench import Bench
from hilbed.build.minds import ESTIMATOR_STREAM, Guidance, Surroundings, make_controller, make_estimator
from hilbed.clock import nanos
from hilbed.cost import Cost
from hilbed.loop import Rig, at_once
from hilbed.pacer import Pacer
from hilbed.plant.recorded import Recorded
from hilbed.plant.recorded_spec import RecordedSpec
from hilbed.plant.recording import load
from hilbed.plant.replay import RecordedBase, RecordedPlant, RecordedSensor
from hilbed.ports import Witness
from hilbed.scenario import files
from hilbed.scenario.load import Loaded
from hilbed.scene import BeaconSpec


def recorded(loaded: Loaded, witness: Witness, cost: Cost, _: bool, pacer: Pacer | None) -> Bench:
    """Returns a bench whose odometry, readings and truth come from a file; raises ScenarioError."""
    scenario, spec = loaded.scenario, loaded.scenario.plant
    assert isinstance(spec, RecordedSpec)
    robot = _robot(loaded)
    sensors = tuple(RecordedSensor(robot, kind, witness) for kind in spec.kinds())
    reference = None if scenario.reference is None else scenario.reference.build()
    period = nanos(scenario.period)
    rig = Rig(
        RecordedBase(robot),
        sensors,
        make_estimator(scenario.estimator, _known(robot, scenario.seed)),
        make_controller(scenario.controller, Guidance(reference, period)),
        RecordedPlant(robot),
        period,
        cost,
    )
    beacons = tuple(BeaconSpec(at=at) for at in robot.beacons)
    pace = at_once if pacer is None else pacer.due
    return Bench(rig, robot.start, reference, (), dict.fromkeys(spec.kinds(), 1), beacons, pace=pace)


def known_of(loaded: Loaded) -> Surroundings:
    """Returns what the estimator of a recorded robot knows from the start; raises ScenarioError."""
    return _known(_robot(loaded), loaded.scenario.seed)


def _robot(loaded: Loaded) -> Recorded:
    spec = loaded.scenario.plant
    assert isinstance(spec, RecordedSpec)
    return Recorded(spec, load(files.resolve(spec.file, loaded.folder)))


def _known(robot: Recorded, seed: int) -> Surroundings:
    return Surroundings(robot.beacons, robot.start, robot.mount, rng.stream(seed, ESTIMATOR_STREAM))
