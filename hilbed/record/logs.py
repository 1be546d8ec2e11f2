"""The logs that a run writes as it goes, and where."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from hilbed.record.candump import CandumpLog
from hilbed.record.frames import Frames
from hilbed.record.mcap import McapLog, Setting
from hilbed.record.row import Sink
from hilbed.types import Nanos


class Plan(NamedTuple):
    """Which logs a run writes into its folder.

    offset: ns, added to t for the time in a log; bus: whether there is one, with frames to log.
    """

    folder: Path
    offset: Nanos
    setting: Setting
    bus: bool


def open_logs(plan: Plan) -> list[Sink]:
    """Starts the logs; raises RecordError."""
    folder, offset, setting, bus = plan
    sinks: list[Sink] = [McapLog(folder / "log.mcap", offset, setting), Frames(folder / "frames")]
    return [CandumpLog(folder / "can.log", offset), *sinks] if bus else sinks
