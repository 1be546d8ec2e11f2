"""What acts on the runs of a section besides what the paper says: errors of the sensors, disturbances."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

import yaml

from hilbed.paper.catalogue import TWIN
from hilbed.paper.tables import short
from hilbed.report import page
from hilbed.report.run import Run, Span

PLACED = ("kind", "drive", "node", "start", "length", "corner", "opposite", "shape", "rise")
"""Keys of a disturbance that its letter's line says otherwise."""

WORDS = ("noise", "missed", "spurious", "loss", "dropout", "latency", "rate", "first", "front")
"""What the keys of a sensor's errors and of its timing contain."""


def acting(names: Sequence[str], runs: Mapping[str, Run]) -> str | None:
    """Returns what acts on these scenarios and their twins, alike ones together; None where nothing does."""
    groups: dict[str, list[str]] = {}
    for name in (full for one in names for full in (one, one + TWIN)):
        if name in runs and (told := _told(runs[name])):
            groups.setdefault(told, []).append(short(name))
    lines = [f"<p><b>{escape(', '.join(alike))}</b></p>{told}" for told, alike in groups.items()]
    return "".join(lines) or None


def _told(run: Run) -> str:
    scenario = yaml.safe_load(run.scenario) or {}
    sensors = [_sensor(name, block) for name, block in (scenario.get("sensors") or {}).items()]
    blocks = scenario.get("disturbances") or []
    upsets = [_upset(span, block) for span, block in zip(run.spans, blocks, strict=True)]
    return f'<ul class="chips">{"".join(sensors + upsets)}</ul>' if upsets else ""


def _upset(span: Span, block: Mapping[str, Any]) -> str:
    return (
        f"<li><b>{span.letter}</b> {escape(span.about)} <small>{_sizes(block)}{page.when(span)}</small></li>"
    )


def _sizes(block: Mapping[str, Any]) -> str:
    """Returns what else a disturbance is given, as the scenario has it."""
    given = {key: value for key, value in block.items() if key not in PLACED and value is not None}
    return "".join(f"{escape(key)} {escape(_shown(value))}, " for key, value in given.items())


def _sensor(name: str, block: Mapping[str, Any]) -> str:
    """Returns when a sensor reads and what it does wrong, as the scenario has it."""
    given = {key: value for key, value in block.items() if value and any(word in key for word in WORDS)}
    words = ", ".join(f"{key.replace('_', ' ')} {_shown(value)}" for key, value in given.items())
    return f"<li>{escape(name)} <small>{escape(words)}</small></li>"


def _shown(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
