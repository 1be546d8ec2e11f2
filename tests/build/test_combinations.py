"""Everything that a scenario may combine runs: half a second of each."""

from __future__ import annotations

import json
from pathlib import Path
from typing import get_args

import pytest

from hilbed.build.minds import CONTROLLERS, ESTIMATORS
from hilbed.can.specs import NodeSpec
from hilbed.control import ReferenceSpec
from hilbed.runner import perform
from hilbed.scenario.load import load
from hilbed.sensors.pan_spec import AnyPan
from tests.build.scenarios import small
from tests.build.test_kinds import kinds

BLOCKS = {"waypoints": {"points": [[0, 0], [2, 0], [3, 2]]}}  # the others need no more than their kind
LOOPS = get_args(NodeSpec.model_fields["loop"].annotation)


def metrics(tmp_path: Path, *settings: str) -> dict[str, float]:
    """Runs the small scenario with settings, sees that it ends well, and returns what it measures."""
    outcome = perform(load(str(small(tmp_path)), ["duration=0.5", *settings]), None)
    assert (outcome.status, outcome.trace) == (0, ""), outcome.verdict["reason"]
    return dict(outcome.verdict["metrics"])


@pytest.mark.parametrize("loop", LOOPS)
@pytest.mark.parametrize("pan", kinds(AnyPan))
@pytest.mark.parametrize("reference", kinds(ReferenceSpec))
@pytest.mark.parametrize("controller", CONTROLLERS)
@pytest.mark.parametrize("estimator", ESTIMATORS)
def test_it_runs(
    tmp_path: Path, estimator: str, controller: str, reference: str, pan: str, loop: str
) -> None:
    block = json.dumps({"kind": reference, "speed": 0.4, "acceleration": 1.0, **BLOCKS.get(reference, {})})
    found = metrics(
        tmp_path,
        f"estimator={estimator}",
        f"controller={controller}",
        f"reference={block}",
        f"sensors.camera.pan={{kind: {pan}}}",
        f"nodes={{left: {{kind: simulated, loop: {loop}}}, right: {{kind: simulated, loop: {loop}}}}}",
    )
    assert found["estimate_position_rms"] < 0.02
    assert found["reference_distance_rms"] < 0.05


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
