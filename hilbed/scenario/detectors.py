"""Foreign detectors that a scenario names: whose code may be run, and how a run keeps it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from hilbed.problems import Problem
from hilbed.scenario import files
from hilbed.sensors import CameraSpec, SensorSpec
from hilbed.types import ScenarioError
from hilbed.vision.code import Code, moved, parse
from hilbed.vision.detectors import KINDS, ForeignSpec


def give(data: Mapping[str, Any], detector: str) -> None:
    """Lays `--detector` over every camera; a file is meant from the current folder. Raises ScenarioError."""
    sensors = data.get("sensors")
    blocks = sensors.items() if isinstance(sensors, dict) else ()
    cameras = [name for name, block in blocks if block == "camera" or _kind(block) == "camera"]
    if not cameras:
        raise ScenarioError(f"--detector {detector}: the scenario has no camera")
    for name in cameras:
        block = data["sensors"][name]
        block = {"kind": block} if isinstance(block, str) else block
        data["sensors"][name] = {**block, "detector": given(detector, block.get("detector"))}


def given(detector: str, before: Any) -> Any:
    """Returns the detector's block: deadline and options of a foreign one stay."""
    if detector in KINDS:
        return detector
    try:
        code = moved(detector, Path.absolute)
        _check_anywhere(parse(code))
    except (ValueError, ScenarioError) as error:
        raise ScenarioError(f"--detector {detector}: {error}") from None
    kept = before if _kind(before) == "foreign" else {}
    return {**kept, "kind": "foreign", "code": code}


def _kind(block: Any) -> Any:
    return block.get("kind") if isinstance(block, dict) else None


def localise(sensors: Mapping[str, SensorSpec], folder: Path) -> dict[str, SensorSpec]:
    """Returns the sensors with absolute paths of code."""
    return replaced(sensors, lambda path: path if path.is_absolute() else files.resolve(str(path), folder))


def replaced(sensors: Mapping[str, SensorSpec], change: Callable[[Path], Path]) -> dict[str, SensorSpec]:
    """Returns the sensors with their files of code at other places."""
    return {name: _replaced(sensor, change) for name, sensor in sensors.items()}


def _replaced(sensor: SensorSpec, change: Callable[[Path], Path]) -> SensorSpec:
    if not isinstance(sensor, CameraSpec) or not isinstance(sensor.detector, ForeignSpec):
        return sensor
    code = moved(sensor.detector.code, change)
    return sensor.model_copy(update={"detector": sensor.detector.model_copy(update={"code": code})})


def foreign(sensors: Mapping[str, SensorSpec]) -> Iterator[tuple[str, Code]]:
    """Yields the cameras whose detector is foreign, and its code."""
    for name, sensor in sensors.items():
        if isinstance(sensor, CameraSpec) and isinstance(sensor.detector, ForeignSpec):
            yield name, parse(sensor.detector.code)


def allowed(sensors: Mapping[str, SensorSpec], folder: Path, given: str | None) -> Iterator[Problem]:
    """Code is installed, or lies in the scenario's folder, or is given on the command line."""
    for name, code in foreign(sensors):
        try:
            if given is None:
                _check_inside(code, folder)
        except ScenarioError as error:
            yield Problem(("sensors", name, "detector"), f"sensors.{name}.detector: {error}")


def _check_inside(code: Code, folder: Path) -> None:
    if not code.is_file:
        _check_anywhere(code)
        return
    try:
        files.resolve(code.place, folder)
    except ScenarioError as error:
        raise ScenarioError(f"{error}; a detector from elsewhere is given by --detector") from None


def _check_anywhere(code: Code) -> None:
    package = code.place.partition(".")[0]
    if code.is_file and not Path(code.place).is_file():
        raise ScenarioError(f"there is no file {code.place}")
    if not code.is_file and find_spec(package) is None:
        file = f"{code.place.rpartition('.')[2]}.py:{code.name}"
        raise ScenarioError(f"no module {package} is installed; a file is given by its path, {file}")


def own(sensors: Mapping[str, SensorSpec]) -> set[Path]:
    """Returns the files of code that a run keeps."""
    return {Path(code.place) for _, code in foreign(sensors) if code.is_file}
