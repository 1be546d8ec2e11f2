"""From a name or a file to a scenario that holds: everything wrong with it is told at once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from pydantic import TypeAdapter, ValidationError
from pydantic.fields import FieldInfo

from hilbed import problems, yaml12
from hilbed.scenario import bundled, checks, detectors, overlay, tables
from hilbed.scenario.model import Scenario
from hilbed.types import ScenarioError


class Loaded(NamedTuple):
    """A scenario with its short name, the folder its files are relative to, and its first comment."""

    name: str
    scenario: Scenario
    folder: Path
    title: str


def load(
    name: str, settings: Sequence[str] = (), seed: int | None = None, detector: str | None = None
) -> Loaded:
    """Reads a bundled scenario or a file, with `--set`, `--seed` and `--detector` laid over it.

    detector: of every camera; code that is named so may lie anywhere, the scenario's own may not. Raises
    ScenarioError with every problem, one a line.
    """
    short, path = bundled.find(name)
    text = _text(path)
    data, marks = yaml12.read(text, str(path))
    places = problems.Places(str(path), marks)
    for setting in [*settings, *([] if seed is None else [f"seed={seed}"])]:
        places.overlaid(overlay.apply(data, setting), setting)
    tables.localise(data, path.parent)
    if detector is not None:
        detectors.give(data, detector)
    scenario = _validated(data, places, path.parent, detector)
    scenario = scenario.model_copy(update={"sensors": detectors.localise(scenario.sensors, path.parent)})
    return Loaded(short, scenario, path.parent, bundled.title(text))


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ScenarioError(f"{path}: cannot be read: {error}") from None


def _validated(data: dict[str, Any], places: problems.Places, folder: Path, detector: str | None) -> Scenario:
    found: list[problems.Problem] = []
    try:
        scenario = Scenario.model_validate(data)
        valid: Mapping[str, Any] = {name: getattr(scenario, name) for name in Scenario.model_fields}
    except ValidationError as error:
        found = problems.from_validation(error, Scenario)
        valid = _valid_blocks(data)
    found += checks.across(valid, folder, detector)
    if found:
        raise ScenarioError(places.tell(found))
    return scenario


def _valid_blocks(data: Mapping[str, Any]) -> dict[str, Any]:
    """Returns the blocks that hold by themselves, so that checks across them can still speak."""
    blocks: dict[str, Any] = {}
    for name, field in Scenario.model_fields.items():
        if name not in data and field.is_required():
            continue
        try:
            blocks[name] = _block(field, data[name]) if name in data else field.get_default()
        except ValidationError:
            continue
    return blocks


def _block(field: FieldInfo, value: Any) -> Any:
    return TypeAdapter(field.rebuild_annotation()).validate_python(value)


def resolved(scenario: Scenario, versions: Mapping[str, str]) -> dict[str, Any]:
    """Returns the scenario with every default written out and the versions that ran it."""
    data = scenario.model_dump(mode="json", by_alias=True)
    return {**data, "versions": dict(versions)}


def version_warnings(scenario: Scenario, present: Mapping[str, str]) -> list[str]:
    """Returns a line for each package whose version is not the one that the scenario names."""
    return [
        f"{name} is {present.get(name, 'not installed')}, the scenario was resolved with {version}"
        for name, version in scenario.versions.items()
        if present.get(name) != version
    ]
