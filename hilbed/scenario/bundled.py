"""The scenarios that come with the package."""

from __future__ import annotations

from pathlib import Path

from hilbed.scenario.problems import nearest
from hilbed.types import ScenarioError

FOLDER = Path(__file__).parent.parent / "scenarios"


def names() -> list[str]:
    """Returns the names of the bundled scenarios, such as `slimane2014/load-torque`."""
    files = sorted(FOLDER.rglob("*.yaml"))
    return [file.relative_to(FOLDER).with_suffix("").as_posix() for file in files]


def find(name: str) -> tuple[str, Path]:
    """Returns a scenario's short name and file, for a bundled name or the path of a file.

    Raises ScenarioError with the nearest name.
    """
    bundled = FOLDER / f"{name}.yaml"
    if name in names():
        return name, bundled
    path = Path(name)
    if path.is_file():
        return _short_name(path), path
    if path.suffix in (".yaml", ".yml"):
        raise ScenarioError(f"there is no file {name}")
    raise ScenarioError(f"unknown scenario {name!r}{nearest(name, names())}")


def _short_name(path: Path) -> str:
    if path.resolve().is_relative_to(FOLDER.resolve()):
        return path.resolve().relative_to(FOLDER.resolve()).with_suffix("").as_posix()
    return path.stem
