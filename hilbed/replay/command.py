"""`hilbed replay RUN`: today's controller on yesterday's bus."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from math import isfinite
from pathlib import Path
from typing import Any, NamedTuple

from hilbed import loop
from hilbed.record.columns import Columns
from hilbed.record.journal import Journal
from hilbed.record.notes import Notes
from hilbed.record.readings import Signals
from hilbed.replay.differences import Difference, compared, differences
from hilbed.replay.recording import Recording, read_recording
from hilbed.replay.rig import rig_of
from hilbed.scenario.load import version_warnings
from hilbed.types import HilbedError
from hilbed.versions import versions

IDENTICAL, DIFFERS = 0, 1


class Replayed(NamedTuple):
    """Signals of a replay, and why it ended before the record, if it did."""

    signals: Signals
    reason: str


def replay(folder: Path, settings: Sequence[str], as_json: bool) -> int:
    """Replays a run, tells where it differs from its record, returns the status; raises ScenarioError."""
    recording = read_recording(folder, settings)
    for warning in version_warnings(recording.loaded.scenario, versions()):
        print(f"warning: {warning}", file=sys.stderr)
    replayed = perform(recording)
    found = differences(recording.signals, replayed.signals)
    if as_json:
        print(json.dumps(_summary(recording, replayed, found), indent=2))
    else:
        print(_table(recording, replayed, found))
    return DIFFERS if found or replayed.reason else IDENTICAL


def perform(recording: Recording) -> Replayed:
    """Runs odometry, estimator and controller over as many cycles as were recorded."""
    rig, start, reference = rig_of(recording)
    scenario = recording.loaded.scenario
    columns = Columns(scenario.robot.drives)
    journal = Journal(Notes(), [columns], rig.cost, start, reference)
    reason = ""
    try:
        for cycle in loop.run(rig, (len(recording.signals["t"]) - 1) * rig.period):
            journal.record(cycle)
    except HilbedError as error:  # a drive that was silent, an estimate that is lost
        reason = str(error)
    journal.close()
    return Replayed(columns.finish(), reason)


def _table(recording: Recording, replayed: Replayed, found: Sequence[Difference]) -> str:
    rows = len(recording.signals["t"])
    head = f"{rows} cycles, {len(recording.frames)} frames, {len(compared(replayed.signals))} columns"
    lines = [f"{head}: {'differs' if found or replayed.reason else 'identical'}"]
    if replayed.reason:
        lines.append(f"the replay ended early: {replayed.reason}")
    width = max((len(one.column) for one in found), default=0)
    for column, first, largest, at in found:
        size = (
            f"by up to {largest:.3g} at {at:.6g} s" if isfinite(largest) else "where one side has no number"
        )
        lines.append(f"{column.ljust(width)}  from {first:.6g} s on, {size}")
    return "\n".join(lines)


def _summary(recording: Recording, replayed: Replayed, found: Sequence[Difference]) -> dict[str, Any]:
    return {
        "identical": not found and not replayed.reason,
        "reason": replayed.reason,
        "cycles": len(recording.signals["t"]),
        "frames": len(recording.frames),
        "compared": compared(replayed.signals),
        "differences": {
            one.column: {
                "first": one.first,
                "largest": one.largest if isfinite(one.largest) else None,
                "at": one.at,
            }
            for one in found
        },
    }
