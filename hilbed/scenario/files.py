"""Where a scenario may read files: its own folder, the package, the data folder; nowhere else."""

from __future__ import annotations

import os
from pathlib import Path

from hilbed.plant import KinematicSpec, PlantSpec, RecordedSpec
from hilbed.resources import package_file
from hilbed.robots import RobotSpec
from hilbed.types import ScenarioError

SCHEMES = ("package", "data")


def named(robot: RobotSpec, plant: PlantSpec) -> list[tuple[tuple[str, str], str]]:
    """Returns the files that a scenario names and needs, each with the path of its key."""
    if isinstance(plant, RecordedSpec):
        return [(("plant", "file"), plant.file)]
    if isinstance(plant, KinematicSpec):
        return []
    return [(("robot", "urdf"), robot.urdf)]


def resolve(name: str, folder: Path) -> Path:
    """Returns the file meant by `package:…`, `data:…` (folder HILBED_DATA) or a path inside `folder`.

    Raises ScenarioError where the file is missing, or outside the three.
    """
    scheme, rest = _split(name)
    if scheme == "package":
        return package_file(rest)
    return _inside(_data_folder(name) if scheme == "data" else folder, rest, name)


def beside(other: str, name: str, folder: Path) -> Path:
    """Returns the file that the file `name` calls `other`, from its own place; raises ScenarioError."""
    near = resolve(name, folder).parent
    scheme, _ = _split(name)
    root = near if scheme == "package" else _data_folder(name) if scheme == "data" else folder
    return _inside(root, str(near / other), other)


def is_own(name: str) -> bool:
    """Tells whether a name means a file in the scenario's own folder."""
    return not _split(name)[0]


def _split(name: str) -> tuple[str, str]:
    scheme, colon, rest = name.partition(":")
    return (scheme, rest) if colon and scheme in SCHEMES else ("", name)


def _data_folder(name: str) -> Path:
    folder = os.environ.get("HILBED_DATA")
    if not folder:
        raise ScenarioError(
            f"{name} needs the environment variable HILBED_DATA to name the folder of the data"
        )
    return Path(folder)


def _inside(folder: Path, rest: str, name: str) -> Path:
    root = folder.resolve()
    path = (root / rest).resolve()
    if not path.is_relative_to(root):
        raise ScenarioError(f"{name} leaves {folder}; a scenario reads its own folder, package:… and data:…")
    if not path.is_file():
        raise ScenarioError(f"there is no file {name} (looked for {path})")
    return path
