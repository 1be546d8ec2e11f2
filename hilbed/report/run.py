"""A run folder as the report reads it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from math import inf
from pathlib import Path
from typing import Any, NamedTuple
from zipfile import BadZipFile

import numpy as np
import yaml

from hilbed.criteria import Signals
from hilbed.record.folder import FRAMES, SCENARIO, SIGNALS, VERDICT
from hilbed.record.frames import INDEX
from hilbed.types import HilbedError


class ReportError(HilbedError):
    """A run folder that cannot be read."""


class Span(NamedTuple):
    """A disturbance: a letter for the figures, what it is, from and to (s; inf for good).

    area: x, y of two opposite corners (m) where it is a place, else empty.
    """

    letter: str
    about: str
    start: float
    end: float
    area: tuple[float, ...] = ()


NO_COLOUR = "none"


class Beacon(NamedTuple):
    """A beacon on the map: place (m) and the name of its colour."""

    x: float
    y: float
    colour: str


class Shot(NamedTuple):
    """A camera frame: time (s), PNG, columns of the detections and the beacons they were taken for."""

    t: float
    png: bytes
    pixels: tuple[float, ...]
    beacons: tuple[int | None, ...]


class Run(NamedTuple):
    """Everything that the report shows; parts that the run lacks are empty."""

    folder: Path
    scenario: str
    verdict: Mapping[str, Any]
    signals: Signals
    spans: tuple[Span, ...]
    beacons: tuple[Beacon, ...]
    shots: tuple[Shot, ...]


def read_run(folder: Path) -> Run:
    """Reads a run folder; raises ReportError naming the file that is missing or broken."""
    if not folder.is_dir():
        raise ReportError(f"{folder} is not a folder")
    text = _read(folder / SCENARIO).decode(errors="replace")
    scenario = _parsed(folder / SCENARIO, lambda: yaml.safe_load(text))
    verdict = _parsed(folder / VERDICT, lambda: _verdict(folder / VERDICT))
    signals = _parsed(folder / SIGNALS, lambda: _signals(folder / SIGNALS))
    shots = _parsed(folder / FRAMES, lambda: _shots(folder / FRAMES))
    spans = _parsed(folder / SCENARIO, lambda: _spans(scenario))
    beacons = _parsed(folder / SCENARIO, lambda: _beacons(scenario, signals))
    return Run(folder, text, verdict, signals, spans, beacons, shots)


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise ReportError(f"{path}: {error.strerror}; is {path.parent} a run folder?") from error


def _parsed(path: Path, parse: Any) -> Any:
    try:
        return parse()
    except (ValueError, KeyError, TypeError, AttributeError, yaml.YAMLError, BadZipFile, EOFError) as error:
        raise ReportError(f"{path} is not what a run writes: {error}") from error


def _verdict(path: Path) -> dict[str, Any]:
    verdict: dict[str, Any] = json.loads(_read(path))
    for key in (
        "scenario",
        "seed",
        "passed",
        "reason",
        "criteria",
        "metrics",
        "sim_time",
        "wall_time",
        "cost",
    ):
        if key not in verdict:
            raise ValueError(f"it has no {key}")
    return verdict


def _signals(path: Path) -> Signals:
    _read(path)
    with np.load(path, allow_pickle=False) as archive:
        signals = Signals(archive)
    if "t" not in signals:
        raise ValueError("it holds no column t")
    return signals


def _shots(folder: Path) -> tuple[Shot, ...]:
    if not (folder / INDEX).exists():
        return ()
    entries = [json.loads(line) for line in _read(folder / INDEX).splitlines()]
    return tuple(
        Shot(one["t"], _read(folder / Path(one["file"]).name), tuple(one["pixels"]), tuple(one["beacons"]))
        for one in entries
    )


def _spans(scenario: Mapping[str, Any]) -> tuple[Span, ...]:
    blocks = scenario.get("disturbances") or []
    return tuple(_span(chr(65 + k % 26), block) for k, block in enumerate(blocks))


def _span(letter: str, block: Mapping[str, Any]) -> Span:
    about = block.get("drive") or block.get("node")
    words = [str(block["kind"]).replace("_", " "), *([str(about)] if about else [])]
    start, length = float(block.get("start") or 0.0), block.get("length")
    corners = (block.get("corner"), block.get("opposite"))
    area = tuple(float(part) for corner in corners for part in corner or ()) if all(corners) else ()
    return Span(letter, " · ".join(words), start, inf if length is None else start + float(length), area)


def _beacons(scenario: Mapping[str, Any], signals: Signals) -> tuple[Beacon, ...]:
    """Returns where the beacons stood, in the colours that the scenario gives them, if it does."""
    blocks = (scenario.get("plant") or {}).get("beacons") or []
    colours = [str(block.get("colour", "red")) for block in blocks]
    places = signals["beacons"].tolist() if "beacons" in signals else []
    colours += [NO_COLOUR] * (len(places) - len(colours))
    return tuple(Beacon(x, y, colour) for (x, y), colour in zip(places, colours, strict=False))
