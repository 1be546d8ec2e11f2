"""Robot × plant × estimator × controller × reference: each runs with finite numbers, or is told why not."""

from __future__ import annotations

import json
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hilbed.build.minds import CONTROLLERS, ESTIMATORS
from hilbed.control import ControllerSpec, ReferenceSpec
from hilbed.estimation import EstimatorSpec
from hilbed.plant import PlantSpec
from hilbed.robots import ROBOTS
from hilbed.scenario.load import load
from hilbed.sensors import SensorSpec
from hilbed.tally import ABOUT
from hilbed.types import ScenarioError
from tests.bench import ran
from tests.build.test_kinds import kinds

WHOLE = """\
duration: {duration}
period: {period}
robot: {{kind: {robot}, start: [2, -1, 0.3]}}
plant: {{kind: {plant}, beacons: [{{at: [0, 0], colour: red}}, {{at: [0, 3], colour: blue}}]}}
sensors:
  eye: {{kind: bearing, rate: 20, latency: 0}}
  gps: {{kind: position, rate: 20, noise: 0.01, latency: 0}}
  fix: {{kind: position, rate: 20, noise: 0.01, yaw_noise: 0.01, latency: 0}}
estimator: {estimator}
controller: {controller}
"""
TIMES = {"kinematic": (0.25, 0.05), "bullet": (0.1, 0.01)}  # duration and period, s
PATHS = {
    "line": {}, "circle": {}, "stadium": {}, "figure_eight": {},
    "waypoints": {"points": [[0, 0], [2, 0], [3, 2]]}, "legs": {"start": [-9, 4, 0]},
}  # fmt: skip
REFERENCES: dict[str, dict[str, Any] | None] = {**PATHS, "point": {"pose": [1, 0.5, 1]}, "none": None}
TRACKERS = ("lqr", "open_loop", "lyapunov")
ALONE = ("path_following", "ramps")


def test_the_matrix_is_complete() -> None:
    assert sorted(REFERENCES) == sorted([*kinds(ReferenceSpec), "none"])
    assert sorted(TIMES) == sorted(set(kinds(PlantSpec)) - {"recorded"})
    assert sorted(CONTROLLERS) == sorted([*TRACKERS, *ALONE, "cloud", "front_point"])


def reasons(robot: str, controller: str, reference: str) -> list[str]:
    """Why these do not go together; nothing where they do."""
    why = []
    if controller == "cloud" and robot == "tricycle":
        why.append("cloud turns the robot on the spot, which a tricycle cannot; use a diffdrive")
    if reference == "none" and controller not in ALONE:
        why.append(f"reference is missing: the controller {controller} follows one")
    if controller in TRACKERS and reference == "point":
        why.append(f"a point stands, and {controller} follows what moves; cloud drives to a point")
    if controller == "cloud" and reference in PATHS:
        why.append(f"cloud drives to a point, {reference} moves; use lqr, lyapunov or front_point")
    return why


def run_with(robot: str, plant: str, estimator: str, controller: str) -> list[str]:
    """References to run with: on the ideal plant all that fit, on the bench one of them, each in its turn."""
    fit = [reference for reference in REFERENCES if not reasons(robot, controller, reference)]
    return fit if plant == "kinematic" else fit[list(ESTIMATORS).index(estimator) % max(len(fit), 1) :][:1]


@pytest.mark.parametrize("estimator", ESTIMATORS)
@pytest.mark.parametrize("robot", ROBOTS)
@pytest.mark.parametrize("plant", TIMES)
def test_it_runs_or_is_refused_with_every_reason(
    tmp_path: Path, plant: str, robot: str, estimator: str
) -> None:
    file = tmp_path / "whole.yaml"
    duration, period = TIMES[plant]
    for controller, (reference, block) in product(CONTROLLERS, REFERENCES.items()):
        text = WHOLE.format(**locals())
        text += "" if block is None else "reference: " + json.dumps({"kind": reference, **block}) + "\n"
        file.write_text(text)
        why = reasons(robot, controller, reference)
        if why:
            with pytest.raises(ScenarioError) as refused:
                load(str(file))
            told = str(refused.value)
            assert len(told.splitlines()) == len(why)
            assert all(reason in told for reason in why)
            assert all(line.startswith(f"{file}:") for line in told.splitlines())
            continue
        if reference in run_with(robot, plant, estimator, controller):
            run = ran(file)
            assert (run.status, run.verdict["reason"]) == (0, ""), (controller, reference)
            assert all(np.isfinite(run.signals[name]).all() for name in ("truth", "estimate", "command"))
            assert all(set(counts) <= set(ABOUT) for counts in run.verdict["counts"].values())


SENSORS = {
    "camera": {"azimuth"}, "bearing": {"azimuth"}, "range_bearing": {"range", "azimuth"},
    "position": {"position"}, "position, yaw_noise: 0.01": {"pose"},
}  # fmt: skip
FOOD = {
    "ekf": {"azimuth", "range"}, "particles": {"position", "pose"}, "attitude": {"position"},
    "measured": {"pose"}, **{kind: {"azimuth"} for kind in ESTIMATORS if kind.startswith("bearing_")},
}  # fmt: skip


@pytest.mark.parametrize("plant", TIMES)
@pytest.mark.parametrize("robot", ROBOTS)
@pytest.mark.parametrize("sensor", SENSORS)
def test_an_estimator_is_refused_what_it_cannot_live_on(
    tmp_path: Path, sensor: str, robot: str, plant: str
) -> None:
    duration, period = TIMES[plant]
    for estimator in ESTIMATORS:
        text = WHOLE.format(controller="ramps", **locals())
        head, tail = text[: text.index("sensors:")], text[text.index("estimator:") :]
        file = tmp_path / "whole.yaml"
        file.write_text(f"{head}sensors: {{only: {{kind: {sensor}}}}}\n{tail}")
        if SENSORS[sensor] & FOOD.get(estimator, SENSORS[sensor]):
            load(str(file))
            continue
        needs = f"whole.yaml:6: estimator: {estimator} needs readings of "
        with pytest.raises(ScenarioError, match=needs):
            load(str(file))


def test_every_kind_is_in_the_matrix() -> None:
    assert {sensor.partition(",")[0] for sensor in SENSORS} == set(kinds(SensorSpec))
    assert set(FOOD) == set(kinds(EstimatorSpec)) - {"odometry"}
    assert sorted(CONTROLLERS) == sorted(kinds(ControllerSpec))
