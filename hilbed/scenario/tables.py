"""Drive tables that a scenario has in its own folder: where they are, and how a run keeps them."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from hilbed.can.drive_table import is_file
from hilbed.can.specs import NodeSpec
from hilbed.scenario import files
from hilbed.types import ScenarioError


def localise(data: Mapping[str, Any], folder: Path) -> None:
    """Makes the paths of tables absolute; one that the scenario may not read is left for its own check."""
    nodes = data.get("nodes")
    for block in nodes.values() if isinstance(nodes, dict) else ():
        name = block.get("table") if isinstance(block, dict) else None
        if isinstance(name, str) and is_file(name):
            with suppress(ScenarioError):
                block["table"] = str(files.resolve(name, folder))


def own(nodes: Mapping[str, NodeSpec], folder: Path) -> set[Path]:
    """Returns the tables that lie in the scenario's folder."""
    found = {Path(spec.table) for spec in nodes.values() if is_file(spec.table)}
    return {path for path in found if path.is_relative_to(folder.resolve())}


def moved(nodes: Mapping[str, NodeSpec], places: Mapping[Path, str]) -> dict[str, NodeSpec]:
    """Returns the nodes with their tables at other places."""
    return {
        name: spec.model_copy(update={"table": places.get(Path(spec.table), spec.table)})
        for name, spec in nodes.items()
    }
