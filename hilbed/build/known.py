"""What both a simulated bench and a replay know from the scenario: start, beacons, drives."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from hilbed import rng
from hilbed.build.bench import BOOT
from hilbed.build.minds import ESTIMATOR_STREAM, Surroundings
from hilbed.can.node import HERE, Node
from hilbed.can.specs import resolve
from hilbed.clock import SECOND, seconds
from hilbed.plant.specs import SimulatedSpec, SteeringSpec
from hilbed.ports import Reference
from hilbed.robots import RobotSpec, TricycleSpec
from hilbed.scenario.model import Scenario
from hilbed.scene import BeaconSpec
from hilbed.sensors.mounts import mounts
from hilbed.types import Nanos, Pose

BRAKING = 2.5
"""m/s²; a tricycle whose wheels brake harder slides on: not all of them have a drive, or carry much."""

SEARCH = 8 * SECOND
"""How much longer the boot is where an axis looks for its home; at the latest it has found it by then."""

SEARCH_SPEED, EDGE_SPEED = 0.5, 0.05
"""rad/s, towards the home switch and over its edge."""

BEHIND = 0.2
"""rad; a steering axis that is so far behind its demand is jammed."""


def start_of(scenario: Scenario, reference: Reference | None) -> Pose:
    """Returns where the robot stands at t = 0: as told, else where the reference starts."""
    if scenario.robot.start is not None:
        return Pose(*scenario.robot.start)
    return Pose(0.0, 0.0, 0.0) if reference is None else reference.at(0).pose


def told_of(scenario: Scenario, start: Pose) -> Pose:
    """Returns where the estimator is told that the robot stands at t = 0."""
    std = getattr(scenario.plant, "start_std", (0.0, 0.0, 0.0))
    return Pose(*(np.array(start) + rng.stream(scenario.seed, "plant.start").normal(0.0, std)).tolist())


def boot_of(scenario: Scenario) -> Nanos:
    """Returns how long before t = 0 the drives are powered: by so much the logs' time is ahead of t."""
    away = any(node.kind != "simulated" for node in scenario.nodes.values())
    searching = any(node.homing not in (None, HERE) for node in scenario.nodes.values())
    boot = BOOT if scenario.realtime is None or not away else scenario.realtime.boot * SECOND
    return boot + SEARCH if searching else boot


def surroundings(scenario: Scenario, beacons: Sequence[BeaconSpec], start: Pose) -> Surroundings:
    """Returns what an estimator knows from the start."""
    mount = next(iter(mounts(scenario.sensors).values()), (0.0, 0.0))
    chance = rng.stream(scenario.seed, ESTIMATOR_STREAM)
    return Surroundings([beacon.at for beacon in beacons], start, mount, chance)


def nodes_of(scenario: Scenario, spec: SimulatedSpec, drives: Iterable[str]) -> tuple[Node, ...]:
    """Returns the drives on the bus in the robot's order; ScenarioError with everything that is wrong."""
    nodes = resolve(scenario.nodes, drives)
    fastest = scenario.real_speed_limit / scenario.robot.wheel_radius
    return tuple(
        _known_to_itself(node, scenario, fastest)
        if node.kind == "real"
        else _homed(_limited(_told(node, spec), scenario.robot), spec.steering)
        for node in nodes
    )


def _limited(node: Node, robot: RobotSpec) -> Node:
    """Returns a tricycle's drive as it is told at boot how far and how fast it may turn, how hard brake."""
    if not isinstance(robot, TricycleSpec):
        return node
    if not node.table.positions:
        rate = BRAKING / robot.wheel_radius * abs(node.counts_per_radian)
        braking = {"quick_stop": rate} if "quick_stop" in node.table.settings else {}
        return replace(node, settings={**braking, **node.settings})
    end = robot.max_steering * abs(node.counts_per_radian)
    ends = {"lowest": -end, "highest": end, "following_window": BEHIND * abs(node.counts_per_radian)}
    if node.mode == "pp":
        ends["profile_velocity"] = robot.max_steering_rate * abs(node.counts_per_radian)
    return replace(node, max_speed=robot.max_steering_rate, settings={**ends, **node.settings})


def _known_to_itself(node: Node, scenario: Scenario, fastest: float) -> Node:
    """Returns a real drive, which knows its motor, with its highest speed, an axis also with its ends."""
    return _limited(node, scenario.robot) if node.table.positions else replace(node, max_speed=fastest)


def _homed(node: Node, steering: SteeringSpec | None) -> Node:
    """Returns a drive that is to look for its home as it is told where that is and how to look."""
    if steering is None or steering.switch is None or not node.searches:
        return node
    per_radian = abs(node.counts_per_radian)
    search = {
        "home": steering.switch * per_radian,
        "homing_speed": SEARCH_SPEED * per_radian,
        "homing_edge_speed": EDGE_SPEED * per_radian,
        "homing_timeout": 1e3 * seconds(SEARCH),
    }
    return replace(node, settings={**search, **node.settings})


def _told(node: Node, spec: SimulatedSpec) -> Node:
    """Returns a node that is told at boot what it drives, where the scenario does not say otherwise.

    Not for a real drive, which knows its motor better than the scenario does.
    """
    motor, gear, encoder = spec.machine(node.name)
    plate = {
        "counts_per_turn": encoder.resolution,
        "resistance": motor.resistance,
        "back_emf": motor.back_emf * gear.ratio,
    }
    known = {key: value for key, value in plate.items() if key in node.table.settings}
    return replace(node, settings={**known, **node.settings})
