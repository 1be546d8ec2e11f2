"""The verdict on a run: verdict.json (a contract) and a table for the terminal."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping, Sequence
from math import inf, isfinite
from typing import Any, NamedTuple, TextIO

from hilbed.criteria import CriterionSpec, Judged, all_metrics, judge, window, window_text
from hilbed.criteria.signals import Column


class Account(NamedTuple):
    """What the runner knows of a run besides its signals.

    reason: why it ended before its time, else empty; sim_time, wall_time, cost: s; events: what the drives
    did that they should not have; beside: of the cost, what other processes spent meanwhile (s); parts: what
    some runs have besides, by its key in verdict.json.
    """

    scenario: str
    seed: int
    reason: str
    sim_time: float
    wall_time: float
    cost: Mapping[str, float]
    hash: str
    signals_hash: str
    events: Sequence[str] = ()
    beside: Mapping[str, float] = {}
    parts: Mapping[str, Any] = {}


def conclude(
    account: Account, signals: Mapping[str, Column], criteria: Mapping[str, CriterionSpec]
) -> dict[str, Any]:
    """Returns the content of verdict.json; a run that ended before its time does not pass.

    Numbers that are not finite are None. Where criteria fail, `reason` names them.
    """
    judged = judge(signals, criteria)
    failed = [f"{name}: {one.reason}" for name, one in judged.items() if not one.passed]
    return {
        "scenario": account.scenario,
        "seed": account.seed,
        "passed": not account.reason and not failed,
        "reason": account.reason or "; ".join(failed),
        "criteria": {name: _entry(one) for name, one in judged.items()},
        "metrics": {name: _finite(value) for name, value in all_metrics(window(signals, 0.0, inf)).items()},
        "sim_time": account.sim_time,
        "wall_time": account.wall_time,
        "real_time_factor": account.sim_time / account.wall_time if account.wall_time > 0 else None,
        "cost": {part: _finite(value) for part, value in account.cost.items()},
        "cost_beside": {part: _finite(value) for part, value in account.beside.items() if value},
        "hash": account.hash,
        "signals_hash": account.signals_hash,
        "events": list(account.events),
        **account.parts,
    }


def text(content: Mapping[str, Any]) -> str:
    """Returns a verdict as the text of verdict.json."""
    return json.dumps(content, indent=2, allow_nan=False) + "\n"


def _entry(one: Judged) -> dict[str, Any]:
    entry: dict[str, Any] = {
        "value": _finite(one.value), "limit": one.limit, "passed": one.passed, "bound": one.bound,
    }  # fmt: skip
    if one.start:
        entry["from"] = one.start
    if one.end is not None:
        entry["to"] = one.end
    return entry if one.passed else entry | {"reason": one.reason}


def _finite(value: float) -> float | None:
    return float(value) if isfinite(value) else None


MOST_EVENTS = 5
"""As many are shown in a terminal."""

_RED, _GREEN, _BOLD, _PLAIN = "\x1b[31m", "\x1b[32m", "\x1b[1m", "\x1b[0m"


def coloured(stream: TextIO) -> bool:
    """Tells whether to colour what goes to a stream: a terminal, and NO_COLOR is not set."""
    return stream.isatty() and not os.environ.get("NO_COLOR")


def table(content: Mapping[str, Any], colour: bool = False) -> str:
    """Returns a verdict as lines for a terminal: the criteria, then how the run went."""
    rows = [_row(name, entry) for name, entry in content["criteria"].items()]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) for row in rows]
    passed = [entry["passed"] for entry in content["criteria"].values()]
    lines = [_mark(line, good, colour) for line, good in zip(lines, passed, strict=True)]
    return "\n".join([*lines, _summary(content, colour)])


def _row(name: str, entry: Mapping[str, Any]) -> tuple[str, ...]:
    sign = "≤" if entry["bound"] == "max" else "≥"
    value = "none" if entry["value"] is None else f"{entry['value']:.4g}"
    limit = f"{sign} {entry['limit']:.4g} {window_text(entry)}".rstrip()
    return name, value, limit, "pass" if entry["passed"] else "FAIL"


def _mark(line: str, good: bool, colour: bool) -> str:
    head, word = line.rstrip()[:-4], line.rstrip()[-4:]
    return f"{head}{_GREEN if good else _RED}{word}{_PLAIN}" if colour else head + word


def _summary(content: Mapping[str, Any], colour: bool) -> str:
    word = "passed" if content["passed"] else "FAILED"
    if colour:
        word = f"{_BOLD}{_GREEN if content['passed'] else _RED}{word}{_PLAIN}"
    factor = content["real_time_factor"]
    speed = f", {factor:.1f} times real time" if factor else ""
    line = f"{content['scenario']} seed {content['seed']}: {word}, {content['sim_time']:g} s simulated{speed}"
    events = content["events"]
    shown = [f"drive event: {event}" for event in events[:MOST_EVENTS]]
    if len(events) > MOST_EVENTS:
        shown.append(f"… and {len(events) - MOST_EVENTS} more drive events in verdict.json")
    parts = [tell(content[part]) for part, tell in _PARTS.items() if part in content]
    told = [content["reason"], *parts, *shown]
    return "\n".join([line, *filter(None, told)])


def _realtime(part: Mapping[str, Any]) -> str:
    late = ", ".join(f"{drive} {count}" for drive, count in part["late_answers"].items() if count)
    answers = f", late answers: {late}" if late else ""
    if not part["cycles"]:
        return f"real time: no cycle{answers}"
    lateness = part["lateness"]
    worst = f"worst {1e3 * lateness['worst']:.2f} ms at t = {lateness['worst_at']:.2f} s"
    missed = f"{part['missed_deadlines']} of {part['cycles']} deadlines missed"
    return f"real time: {missed}, late by {1e3 * lateness['median']:.2f} ms (median), {worst}{answers}"


def _adapter(part: Mapping[str, Any]) -> str:
    counted = (("error frames", "errors"), ("dropped", "dropped"), ("malformed", "malformed"))
    odd = "".join(f", {part[key]} {name}" for name, key in counted if part[key])
    foreign = f" ({part['foreign']} foreign)" if part["foreign"] else ""
    return f"{part['name']}: {part['sent']} frames sent, {part['received']} received{foreign}{odd}"


def _nodes(part: Mapping[str, str]) -> str:
    if all(kind == "simulated" for kind in part.values()):
        return ""
    return "drives: " + ", ".join(f"{name} {kind}" for name, kind in part.items())


def _counts(part: Mapping[str, Mapping[str, float | None]]) -> str:
    """Tells what was counted, where it was anything at all."""
    told = [
        f"{name}: " + ", ".join(f"{key} {value:.4g}" for key, value in counts.items() if value)
        for name, counts in part.items()
        if any(counts.values())
    ]
    return "\n".join(told)


def _detectors(part: Mapping[str, Sequence[str]]) -> str:
    return "\n".join(f"detector of {name}: {line}" for name, lines in part.items() for line in lines)


def _reproducible(part: bool) -> str:
    return "" if part else "not reproducible: the wall clock had a say in this run"


_PARTS: dict[str, Callable[[Any], str]] = {
    "detectors": _detectors,
    "reproducible": _reproducible,
    "counts": _counts,
    "nodes": _nodes,
    "realtime": _realtime,
    "adapter": _adapter,
}
