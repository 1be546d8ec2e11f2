"""The scenarios that come with the package."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from hilbed import yaml12
from hilbed.problems import nearest, shorten
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
    try:
        if path.is_file():
            return _short_name(path), path
        exists = bool(name) and path.exists()
    except (OSError, ValueError) as error:  # no name that a file could have
        raise ScenarioError(f"{shorten(name)}: {getattr(error, 'strerror', None) or error}") from None
    if exists:
        raise ScenarioError(f"{name} is not a file; a scenario is a YAML file or one of `hilbed list`")
    if path.suffix in (".yaml", ".yml"):
        raise ScenarioError(f"there is no file {name}")
    raise ScenarioError(f"unknown scenario {shorten(name)}{nearest(name, names())}")


def _short_name(path: Path) -> str:
    if path.resolve().is_relative_to(FOLDER.resolve()):
        return path.resolve().relative_to(FOLDER.resolve()).with_suffix("").as_posix()
    return path.stem


def summary(name: str) -> tuple[str, str, str, str, str]:
    """Returns robot, plant, estimator, controller and title of a bundled scenario."""
    file = FOLDER / f"{name}.yaml"
    text = file.read_text(encoding="utf-8")
    data, _ = yaml12.read(text, str(file))
    kinds = [_kind(data.get(block)) for block in ("robot", "plant", "estimator", "controller")]
    return kinds[0], kinds[1], kinds[2], kinds[3], title(text)


def _kind(block: Any) -> str:
    if isinstance(block, str):
        return block
    return str(block.get("kind", "-")) if isinstance(block, dict) else "-"


def title(text: str) -> str:
    """Returns the first comment of a scenario's file, its title."""
    first = text.partition("\n")[0]
    return first.removeprefix("#").strip() if first.startswith("#") else ""
