"""Checks of the steering axis: what it can have, find and be judged by, and what only a wheel can."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from hilbed.can.node import HERE
from hilbed.can.specs import NodeSpec
from hilbed.criteria import CriterionSpec, metric_of
from hilbed.disturbances import DisturbanceSpec
from hilbed.plant import PlantSpec, SimulatedSpec
from hilbed.problems import Problem
from hilbed.robots import RobotSpec, TricycleSpec
from hilbed.robots.tricycle import STEERING

Problems = Iterator[Problem]

METHODS = (19, 20)
"""Of homing: those that look for a home switch that is on from an angle on."""

OF_WHEELS = ("speed_rms_error", "step_overshoot", "load_dip", "load_recovery", "slip_max")
"""Metrics of a drive that is told a speed, or that rolls; `criteria.drives` finds none for the axis."""


def _axis(plant: PlantSpec, robot: RobotSpec) -> Problems:
    """Where a steering axis begins and has its switch is within its limits."""
    if not isinstance(plant, SimulatedSpec) or plant.steering is None:
        return
    if not isinstance(robot, TricycleSpec):
        text = f"plant.steering: the robot {robot.kind} has no steering axis; robot: tricycle has"
        yield Problem(("plant", "steering"), text)
        return
    for key, angle in (("start", plant.steering.start), ("switch", plant.steering.switch)):
        if angle is not None and abs(angle) > robot.max_steering:
            limit = f"the axis turns ±{robot.max_steering:g} rad (robot.max_steering)"
            yield Problem(("plant", "steering", key), f"plant.steering.{key}: {angle:g} rad, {limit}")


def _homing(plant: PlantSpec, nodes: Mapping[str, NodeSpec]) -> Problems:
    """A method that looks for a switch needs one, and from either side."""
    node = nodes.get(STEERING)
    if not isinstance(plant, SimulatedSpec) or node is None or node.kind == "real":
        return
    if node.homing in (None, HERE):
        return
    where, place = (("nodes", STEERING, "homing"), f"nodes.{STEERING}.homing: method {node.homing}")
    if node.homing not in METHODS:
        known = f"the bench's axis has a home switch on its positive side: {METHODS[0]} or {METHODS[1]}"
        yield Problem(where, f"{place} looks for another switch; {known}")
    elif plant.steering is None or plant.steering.switch is None:
        yield Problem(where, f"{place} looks for a home switch; plant.steering.switch says where it is")


def _rolling(disturbances: list[DisturbanceSpec]) -> Problems:
    for k, disturbance in enumerate(disturbances):
        if disturbance.kind == "wheel_radius" and disturbance.drive == STEERING:
            text = f"disturbances.{k}.drive: the steering axis does not roll, so that it has no radius"
            yield Problem(("disturbances", k, "drive"), text)


def _judged(criteria: Mapping[str, CriterionSpec]) -> Problems:
    for name, criterion in criteria.items():
        metric = metric_of(name, criterion)
        prefix, _, plain = metric.rpartition(".")
        if plain in OF_WHEELS and STEERING in (criterion.drive, prefix):
            text = f"criteria.{name}: {plain} is about a wheel's speed; the steering axis is told an angle"
            yield Problem(("criteria", name), text)


CHECKS: tuple[Callable[..., Problems], ...] = (_axis, _homing, _rolling, _judged)
