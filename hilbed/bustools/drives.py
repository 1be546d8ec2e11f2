"""Which drives hang on a bus, as told by a scenario, a run folder or a drive table."""

from __future__ import annotations

from pathlib import Path

from hilbed.build.known import nodes_of
from hilbed.can.node import Node
from hilbed.plant.specs import SimulatedSpec
from hilbed.record.folder import SCENARIO
from hilbed.scenario.load import load
from hilbed.types import ScenarioError


def nodes_in(name: str) -> tuple[Node, ...]:
    """Returns the drives of a scenario (a bundled name, a file) or of a run folder; raises ScenarioError."""
    path = Path(name)
    inside = path / SCENARIO
    scenario = load(str(inside) if inside.is_file() else name).scenario
    if not isinstance(scenario.plant, SimulatedSpec):
        raise ScenarioError(f"{name}: a plant of kind {scenario.plant.kind} has no drives on a bus")
    return nodes_of(scenario, scenario.plant, scenario.robot.drives)
