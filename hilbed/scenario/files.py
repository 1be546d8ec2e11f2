"""Where a scenario may read files: its own folder, the package, the data folder; nowhere else."""

from __future__ import annotations

import os
from pathlib import Path

from hilbed.resources import package_file
from hilbed.types import ScenarioError


def resolve(name: str, folder: Path) -> Path:
    """Returns the file meant by `package:…`, `data:…` (folder HILBED_DATA) or a path inside `folder`.

    Raises ScenarioError where the file is missing, or outside the three.
    """
    scheme, colon, rest = name.partition(":")
    if colon and scheme == "package":
        return package_file(rest)
    if colon and scheme == "data":
        return _inside(_data_folder(name), rest, name)
    return _inside(folder, name, name)


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
