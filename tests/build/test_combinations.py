"""Everything that a scenario may combine runs: half a second of each."""

from __future__ import annotations

import json
from pathlib import Path
from typing import get_args

import pytest

from hilbed.can.specs import NodeSpec
from hilbed.control import ReferenceSpec
from hilbed.runner import perform
from hilbed.scenario.load import load
from hilbed.sensors.pan_spec import AnyPan
from hilbed.types import ScenarioError
from tests.build.scenarios import small
from tests.build.test_kinds import kinds

BLOCKS = {"waypoints": {"points": [[0, 0], [2, 0], [3, 2]]}}  # the others need no more than their kind
IDEAL = ("plant={kind: kinematic, beacons: [{at: [3, 0]}]}",)
LOOPS = get_args(get_args(NodeSpec.model_fields["loop"].annotation)[0])


def metrics(tmp_path: Path, *settings: str) -> dict[str, float]:
    """Runs the small scenario with settings, sees that it ends well, and returns what it measures."""
    outcome = perform(load(str(small(tmp_path)), ["duration=0.5", *settings]), None)
    assert (outcome.status, outcome.trace) == (0, ""), outcome.verdict["reason"]
    return dict(outcome.verdict["metrics"])


@pytest.mark.parametrize("loop", LOOPS)
@pytest.mark.parametrize("pan", kinds(AnyPan))
def test_every_loop_runs_with_every_pan_axis(tmp_path: Path, pan: str, loop: str) -> None:
    found = metrics(
        tmp_path,
        f"sensors.camera.pan={{kind: {pan}}}",
        f"nodes={{left: {{kind: simulated, loop: {loop}}}, right: {{kind: simulated, loop: {loop}}}}}",
    )
    assert found["estimate_position_rms"] < 0.02
    assert found["reference_distance_rms"] < 0.05


@pytest.mark.parametrize(
    "reference", [kind for kind in kinds(ReferenceSpec) if kind not in ("point", "legs")]
)
@pytest.mark.parametrize("controller", ["lqr", "open_loop", "lyapunov", "front_point"])
def test_every_tracker_follows_every_reference(tmp_path: Path, controller: str, reference: str) -> None:
    block = json.dumps({"kind": reference, "speed": 0.4, "acceleration": 1.0, **BLOCKS.get(reference, {})})
    found = metrics(tmp_path, f"controller={controller}", f"reference={block}")
    assert found["reference_distance_rms"] < 0.05


REFUSED = {
    ("estimator=particles",): "particles needs readings of position or pose, but camera gives azimuth",
    ("estimator=bearing_kalman",): "plant.beacons: bearing_kalman needs two, at [0, 0] and at [0, l], l > 0",
    ("estimator=bearing_survey", "sensors.camera.mount=[0.1, 0, 0.3]"): "bearings from the axle's midpoint",
    ("controller=cloud",): "cloud drives to a point, line moves",
    ("reference={kind: point, pose: [1, 0, 0]}",): "a point stands, and lqr follows what moves",
    (*IDEAL, "disturbances=[{kind: push, start: 0.1, size: [1, 0]}]"): "push cannot befall an ideal robot",
    (*IDEAL, "nodes={left: simulated}"): "an ideal robot has no drives on a bus",
    (*IDEAL, "bus.interface=virtual"): "an ideal robot has no bus",
    (*IDEAL, "controller=null"): "controller is missing",
    (*IDEAL, "robot={kind: tricycle, max_steering: 1.6}"): "max_steering",
}


@pytest.mark.parametrize("settings", REFUSED, ids=" ".join)
def test_what_cannot_go_together_is_refused_with_its_place_and_reason(
    tmp_path: Path, settings: tuple[str, ...]
) -> None:
    with pytest.raises(ScenarioError) as refused:
        metrics(tmp_path, *settings)
    assert REFUSED[settings] in str(refused.value)
    assert "small.yaml:" in str(refused.value) or "--set " in str(refused.value)


@pytest.mark.parametrize(
    "settings",
    [
        ("plant.chopper={kind: switched}",),
        ("plant.encoder.latency=0.002", "plant.encoder.resolution=8000"),
        ("period=0.02",),
        ("period=0.1", "bus.silent_after=0.5"),
        ("bus.bitrate=1000000",),
        ("bus.bitrate=250000",),
        ("nodes={left: {kind: simulated, mode: pv}, right: {kind: simulated, id: 9, slew: 20}}",),
        ("sensors.camera.identity=anonymous",),
        ("sensors.camera.noise=0.001", "sensors.camera.missed=0.3", "sensors.camera.loss=0.3"),
        ("sensors.camera.mount=[0.1, 0.05, 0.4]", "sensors.camera.latency=0.08"),
        ("sensors.camera.width=320", "sensors.camera.height=48", "sensors.camera.rate=25"),
        ("sensors.rear={kind: camera, pan: {kind: fixed, angle: 3.1}}",),
        ("robot.start=[0.05, -0.05, 0.1]",),
        ("estimator.gate=null", "estimator.inflation=null"),
    ],
    ids=" ".join,
)
def test_other_settings_run_as_well(tmp_path: Path, settings: tuple[str, ...]) -> None:
    assert metrics(tmp_path, *settings)["reference_distance_rms"] < 0.2
