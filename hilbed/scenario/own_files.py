"""A scenario's own files: a run folder keeps them, so that its scenario.yaml runs again wherever it lies."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from hilbed.plant.urdf import meshes
from hilbed.record.folder import FILES
from hilbed.scenario import detectors, files, tables
from hilbed.scenario.model import Scenario
from hilbed.types import ScenarioError


class Packed(NamedTuple):
    """A scenario that names its own files as they lie in a run folder, and their contents by those names."""

    scenario: Scenario
    contents: Mapping[str, bytes]


def pack(scenario: Scenario, folder: Path) -> Packed:
    """Reads the files that a scenario has in its own folder; they keep their places relative to each other.

    Files of the package and of HILBED_DATA stay where they are. Raises ScenarioError.
    """
    own = [(key, name) for key, name in files.named(scenario.robot, scenario.plant) if files.is_own(name)]
    root = folder.resolve()
    own_tables = tables.own(scenario.nodes, root)
    own_code = detectors.own(scenario.sensors)
    found = own_tables | own_code | {path for _, name in own for path in _with_meshes(name, root)}
    if all(path.is_relative_to(root / FILES) for path in found):
        root /= FILES  # a run of a run does not bury its files deeper
    places = {path: _place(path, root) for path in own_tables}
    changes: dict[str, object] = {"nodes": tables.moved(scenario.nodes, places)} if places else {}
    if own_code:
        changes["sensors"] = detectors.replaced(scenario.sensors, lambda path: Path(_place(path, root)))
    for (block, key), name in own:
        place = _place(files.resolve(name, folder), root)
        changes[block] = getattr(scenario, block).model_copy(update={key: place})
    return Packed(
        scenario.model_copy(update=changes), {_place(path, root): _read(path) for path in sorted(found)}
    )


def _with_meshes(name: str, folder: Path) -> Iterator[Path]:
    path = files.resolve(name, folder)
    yield path
    if path.suffix == ".urdf":
        for mesh in (*meshes(path, "collision"), *meshes(path, "visual")):
            with suppress(ScenarioError):  # what is only drawn may be missing
                yield files.beside(mesh, name, folder)


def _place(path: Path, root: Path) -> str:
    if not path.is_relative_to(root):  # a detector given by `--detector`
        return f"{FILES}/{path.name}"
    return f"{FILES}/{path.relative_to(root).as_posix()}"


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise ScenarioError(f"{path}: {error.strerror}") from None
