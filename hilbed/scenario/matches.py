"""Checks of what goes together: robot, estimator, controller and reference."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from hilbed.control import ControllerSpec, ReferenceSpec
from hilbed.estimation import EstimatorSpec
from hilbed.plant import PlantSpec, RecordedSpec
from hilbed.problems import Problem
from hilbed.robots import RobotSpec
from hilbed.sensors import SensorSpec
from hilbed.sensors.mounts import mounts

Problems = Iterator[Problem]

SURVEYORS = ("bearing_lyapunov", "bearing_kalman", "bearing_luenberger", "bearing_survey")
TRACKERS = ("lqr", "lyapunov", "open_loop")


def surveyed(estimator: EstimatorSpec, plant: PlantSpec, sensors: Mapping[str, SensorSpec]) -> Problems:
    """The bearing observers put the map's frame on two landmarks, and see them from the axle's midpoint."""
    if estimator.kind not in SURVEYORS or isinstance(plant, RecordedSpec):
        return
    places = [beacon.at for beacon in plant.beacons]
    if len(places) != 2 or places[0] != (0.0, 0.0) or places[1][0] != 0.0 or places[1][1] <= 0.0:
        text = f"plant.beacons: {estimator.kind} needs two, at [0, 0] and at [0, l], l > 0; given {places}"
        yield Problem(("plant", "beacons"), text)
    for name, place in mounts(sensors).items():
        if place != (0.0, 0.0):
            text = f"sensors.{name}.mount: {place}; {estimator.kind} needs bearings from the axle's midpoint"
            yield Problem(("sensors", name, "mount"), text)


def on_the_spot(controller: ControllerSpec | None, robot: RobotSpec) -> Problems:
    """Point stabilisation turns where it stands."""
    if controller is not None and controller.kind == "cloud" and robot.kind == "tricycle":
        text = "controller: cloud turns the robot on the spot, which a tricycle cannot; use a diffdrive"
        yield Problem(("controller",), text)


def standing(controller: ControllerSpec | None, reference: ReferenceSpec | None) -> Problems:
    """Trackers need a reference that moves; point stabilisation needs one that stands."""
    if controller is None or reference is None:
        return
    if controller.kind in TRACKERS and reference.kind == "point":
        text = f"reference: a point stands, and {controller.kind} follows what moves; cloud drives to a point"
        yield Problem(("reference",), text)
    if controller.kind == "cloud" and reference.kind != "point":
        text = f"reference: cloud drives to a point, {reference.kind} moves; use lqr, lyapunov or front_point"
        yield Problem(("reference",), text)


CHECKS = (surveyed, on_the_spot, standing)
