"""Checks that need more than one block of a scenario; each is asked if all blocks that it needs hold."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from inspect import signature
from pathlib import Path
from typing import Any

from hilbed.can.load import periodic_load
from hilbed.can.specs import BusSpec, NodeSpec, resolve
from hilbed.can.traffic import CONTROLLER, senders
from hilbed.clock import nanos
from hilbed.control import ON_THEIR_OWN, ControllerSpec, ReferenceSpec
from hilbed.criteria import METRICS, CriterionSpec, metric_of
from hilbed.disturbances import DisturbanceSpec
from hilbed.disturbances.bus import BusFault
from hilbed.plant import KinematicSpec, PlantSpec, RecordedSpec, SimulatedSpec
from hilbed.plant.chopper import Switched, periods
from hilbed.plant.urdf import meshes
from hilbed.problems import Problem, nearest
from hilbed.robots import RobotSpec
from hilbed.scenario import detectors, files, matches, sensing, steering, surroundings
from hilbed.scenario.bodies import body_of
from hilbed.sensors import SensorSpec
from hilbed.types import ScenarioError

Problems = Iterator[Problem]


def across(blocks: Mapping[str, Any], folder: Path, given: str | None = None) -> list[Problem]:
    """Returns every problem between the blocks that hold by themselves; given: by `--detector`."""
    known = {**blocks, "folder": folder, "given": given}
    found: list[Problem] = []
    for check in CHECKS:
        needs = list(signature(check).parameters)
        if all(need in known for need in needs):
            found += check(*(known[need] for need in needs))
    return found


def _periods(duration: float, period: float) -> Problems:
    for name, given in (("duration", duration), ("period", period)):
        if not nanos(given):
            yield Problem((name,), f"{name}: {given:g} s is less than a nanosecond")
    if nanos(period) and nanos(duration) % nanos(period):
        yield Problem(
            ("duration",), f"duration: {duration:g} s is not a multiple of the period, {period:g} s"
        )


def _ticks(period: float, plant: PlantSpec) -> Problems:
    if not isinstance(plant, SimulatedSpec):
        return
    tick = nanos(plant.tick)
    if nanos(period) % tick:
        yield Problem(
            ("period",), f"period: {period:g} s is not a multiple of the plant's tick, {plant.tick:g} s"
        )
    if nanos(plant.encoder.latency) % tick:
        latency = f"plant.encoder.latency: {plant.encoder.latency:g} s"
        text = f"{latency} is not a multiple of the tick, {plant.tick:g} s"
        yield Problem(("plant", "encoder", "latency"), text)
    if isinstance(plant.chopper, Switched):
        try:
            periods(plant.chopper, plant.tick)
        except ValueError as error:
            yield Problem(("plant", "chopper"), f"plant.chopper: {error}")


def _nodes(
    robot: RobotSpec, plant: PlantSpec, nodes: Mapping[str, NodeSpec], bus: BusSpec, period: float
) -> Problems:
    if isinstance(plant, KinematicSpec):
        if nodes:
            yield Problem(("nodes",), "nodes: an ideal robot has no drives on a bus; plant: bullet has")
        return
    try:
        resolved = resolve(nodes, robot.drives)
    except ScenarioError as error:
        yield from (Problem(("nodes",), line) for line in str(error).splitlines())
        return
    load = periodic_load(resolved, period, bus.bitrate)
    if load > 1:
        text = f"bus.bitrate: the periodic frames are {load:.0%} of a bus of {bus.bitrate} bit/s"
        yield Problem(("bus", "bitrate"), f"{text}; a longer period or a higher bit rate would do")


def _joined(plant: PlantSpec, bus: BusSpec) -> Problems:
    if bus.carried and not isinstance(plant, SimulatedSpec):
        robot = "an ideal" if isinstance(plant, KinematicSpec) else "a recorded"
        text = f"bus.interface: {bus.interface}; {robot} robot has no bus that could be joined to another"
        yield Problem(("bus", "interface"), text)


def _beacons(plant: PlantSpec) -> Problems:
    if isinstance(plant, SimulatedSpec):
        for k, beacon in enumerate(plant.beacons):
            if max(map(abs, beacon.at)) > plant.arena:
                text = f"plant.beacons.{k}.at: {beacon.at} is outside the world of ±{plant.arena:g} m"
                yield Problem(("plant", "beacons", k, "at"), text)


def _start(plant: PlantSpec, robot: RobotSpec) -> Problems:
    if not isinstance(plant, SimulatedSpec) or robot.start is None:
        return
    if max(map(abs, robot.start[:2])) > plant.arena:
        text = f"robot.start: {robot.start[:2]} is outside the world of ±{plant.arena:g} m"
        yield Problem(("robot", "start"), text)


def _path(plant: PlantSpec, reference: ReferenceSpec | None) -> Problems:
    if isinstance(plant, SimulatedSpec) and reference is not None:
        box = reference.build().extent()
        if max(map(abs, box)) > plant.arena:
            reach = f"x {box[0]:g} … {box[2]:g}, y {box[1]:g} … {box[3]:g} m"
            text = f"reference: the path reaches {reach}, outside the world of ±{plant.arena:g} m"
            yield Problem(("reference",), text)


def _files(robot: RobotSpec, plant: PlantSpec, folder: Path) -> Problems:
    for path, name in files.named(robot, plant):
        try:
            files.resolve(name, folder)
        except ScenarioError as error:
            yield Problem(path, f"{'.'.join(path)}: {error}")


def _body(robot: RobotSpec, plant: PlantSpec, folder: Path) -> Problems:
    """What a URDF lacks is told with the rest; a file that is not there, by `_files`."""
    if isinstance(plant, SimulatedSpec):
        with suppress(ScenarioError):
            path = files.resolve(robot.urdf, folder)
            try:
                body_of(robot, path)
                for mesh in meshes(path, "collision"):
                    files.beside(mesh, robot.urdf, folder)
            except ScenarioError as error:
                yield Problem(("robot", "urdf"), f"robot.urdf: {error}")


def _recording(plant: PlantSpec, duration: float, period: float, folder: Path) -> Problems:
    """What a recorded robot's file holds, and for how long; a file that is not there is told by `_files`."""
    if isinstance(plant, RecordedSpec):
        from hilbed.plant.recorded import Recorded
        from hilbed.plant.recording import load

        with suppress(ScenarioError):
            path = files.resolve(plant.file, folder)
            try:
                robot = Recorded(plant, load(path))
            except ScenarioError as error:
                lines = str(error).splitlines()
                yield from (Problem(("plant", "file"), f"plant.file: {line}") for line in lines)
                return
            if duration > robot.duration + period:
                text = f"duration: {duration:g} s, {plant.file} has {robot.duration:g} s from its start"
                yield Problem(("duration",), text)


def _guidance(
    controller: ControllerSpec | None, reference: ReferenceSpec | None, plant: PlantSpec
) -> Problems:
    if not isinstance(plant, RecordedSpec) and controller is None:
        yield Problem(("controller",), "controller is missing")
    if controller is not None and reference is None and controller.kind not in ON_THEIR_OWN:
        yield Problem(("reference",), f"reference is missing: the controller {controller.kind} follows one")


def _recorded(
    plant: PlantSpec, sensors: Mapping[str, SensorSpec], disturbances: list[DisturbanceSpec]
) -> Problems:
    """A recorded robot brings its own sensors, and what happened to it is over."""
    if isinstance(plant, RecordedSpec):
        for name in sensors:
            yield Problem(
                ("sensors", name), f"sensors.{name}: a recorded robot's readings come from its file"
            )
        for k in range(len(disturbances)):
            yield Problem(("disturbances", k), f"disturbances.{k}: nothing can disturb a recorded robot")
    if isinstance(plant, KinematicSpec):
        for k, disturbance in enumerate(disturbances):
            if disturbance.kind not in sensing.UPSETS:
                text = f"disturbances.{k}: {disturbance.kind} cannot befall an ideal robot; plant: bullet can"
                yield Problem(("disturbances", k), text)


def _disturbed(
    disturbances: list[DisturbanceSpec],
    robot: RobotSpec,
    nodes: Mapping[str, NodeSpec],
) -> Problems:
    drives = robot.drives
    for k, disturbance in enumerate(disturbances):
        place = f"disturbances.{k}"
        drive = getattr(disturbance, "drive", None)
        if drive is not None and drive not in drives:
            text = f"{place}.drive: the robot has no drive {drive!r}{nearest(drive, drives)}"
            yield Problem(("disturbances", k, "drive"), text)
        if disturbance.kind == "load_torque" and drive in [n for n, s in nodes.items() if s.kind == "real"]:
            text = f"{place}.drive: {drive} is real, and nothing here can load its shaft"
            yield Problem(("disturbances", k, "drive"), text)


def _bus_faults(
    disturbances: list[DisturbanceSpec], robot: RobotSpec, nodes: Mapping[str, NodeSpec], bus: BusSpec
) -> Problems:
    """A fault of the bus needs the node or the frames that it is about."""
    drives = robot.drives
    with suppress(ScenarioError):
        sent = senders(resolve(nodes, drives))
        for k, fault in enumerate(disturbances):
            if isinstance(fault, BusFault):
                kinds = {name: spec.kind for name, spec in nodes.items()}
                for key, problem in _no_such(fault, [*drives, CONTROLLER], kinds, {} if bus.guests else sent):
                    yield Problem(("disturbances", k, key), f"disturbances.{k}.{key}: {problem}")


def _no_such(
    fault: BusFault, known: list[str], kinds: Mapping[str, str], sent: Mapping[int, str]
) -> Iterator[tuple[str, str]]:
    """Yields the key of a fault that cannot be, and why; sent: who sends an identifier, empty: anybody."""
    node, identifier = getattr(fault, "node", None), getattr(fault, "identifier", None)
    if node is not None and node not in known:
        yield "node", f"there is no node {node!r} on the bus{nearest(node, known)}"
        return
    if fault.kind == "node_reset" and node == CONTROLLER:
        yield "node", f"only a drive can lose its supply; there are {', '.join(known[:-1])}"
    if fault.kind in ("node_reset", "bus_off") and kinds.get(str(node), "simulated") != "simulated":
        yield "node", f"{node} is {kinds[str(node)]}: its CAN controller and its supply are not here"
    if fault.kind == "babbling_node" or identifier is None or not sent:
        return
    if identifier not in sent:
        yield "identifier", f"nobody sends {identifier:#05x}"
    elif node not in (None, sent[identifier]):
        yield "identifier", f"{identifier:#05x} is sent by {sent[identifier]}, not by {node}"


def _judged(criteria: Mapping[str, CriterionSpec], robot: RobotSpec) -> Problems:
    drives = robot.drives
    for name, criterion in criteria.items():
        if criterion.drive is not None and criterion.drive not in drives:
            known = nearest(criterion.drive, drives)
            text = f"criteria.{name}.drive: the robot has no drive {criterion.drive!r}{known}"
            yield Problem(("criteria", name, "drive"), text)
        metric = metric_of(name, criterion)
        if metric not in METRICS:
            text = f"criteria.{name}: unknown metric {metric!r}{nearest(metric, list(METRICS))}"
            yield Problem(("criteria", name), text)


CHECKS: tuple[Callable[..., Problems], ...] = (
    _periods, _ticks, _nodes, _joined, _beacons, _start, _path,
    _files, _body, _recording, _guidance, _recorded, _disturbed, _bus_faults, _judged,
    detectors.allowed, *sensing.CHECKS, *matches.CHECKS, *steering.CHECKS, *surroundings.CHECKS,
)  # fmt: skip
