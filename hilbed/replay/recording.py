"""What a run folder keeps that a replay needs: scenario, signals, frames with their exact times."""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple
from zipfile import BadZipFile

import numpy as np
import numpy.typing as npt

from hilbed.build import BOOT
from hilbed.build.known import boot_of
from hilbed.clock import SECOND
from hilbed.record.folder import CAN, SCENARIO, SIGNALS
from hilbed.record.readings import Signals
from hilbed.replay.candump import read_log
from hilbed.scenario.load import Loaded, load
from hilbed.types import Nanos, Received, ScenarioError

MICROSECOND: Nanos = 1000


class Recording(NamedTuple):
    """A finished run: frames after the boot, in the order of arrival; t in ns since the start of the run."""

    loaded: Loaded
    signals: Signals
    frames: tuple[Received, ...]


def read_recording(folder: Path, settings: Sequence[str] = ()) -> Recording:
    """Reads a run folder, `--set` laid over its scenario; ScenarioError for what is missing or broken."""
    if not folder.is_dir():
        raise ScenarioError(f"{folder} is not a run folder")
    for name in (SCENARIO, CAN, SIGNALS):
        if not (folder / name).is_file():
            raise ScenarioError(
                f"{folder / name} is missing: only a run with drives, ended and recorded, can be replayed"
            )
    signals = _signals(folder / SIGNALS)
    log = read_log(folder / CAN)
    if not log:
        raise ScenarioError(f"{folder / CAN} holds no frame: there is nothing to replay")
    loaded = load(str(folder / SCENARIO), settings)
    frames = sorted(exact(log, signals, boot_of(loaded.scenario)), key=lambda received: received.t)
    return Recording(loaded, signals, tuple(received for received in frames if received.t > 0))


def _signals(path: Path) -> Signals:
    try:
        with np.load(path, allow_pickle=False) as archive:
            signals = dict(archive)
    except (OSError, ValueError, BadZipFile, EOFError, KeyError) as error:
        raise ScenarioError(f"{path} is not what a run writes: {error}") from None
    if len(signals.get("t", ())) < 1:
        raise ScenarioError(f"{path}: no cycle was recorded")
    return signals


def exact(log: Sequence[Received], signals: Signals, power_on: Nanos = BOOT) -> list[Received]:
    """Returns frames of a log at the run's own time, to the nanosecond where the signals know it.

    The log has microseconds from power-on, which was `power_on` before t = 0; bus/t has the end of every
    frame. A frame that was put into the log later keeps its microseconds.
    """
    known: dict[tuple[int, int], deque[Nanos]] = defaultdict(deque)
    if "bus/t" in signals and "bus/id" in signals:
        for end, identifier in zip(_nanos(signals["bus/t"]), signals["bus/id"].tolist(), strict=True):
            known[max(end + power_on, 0) // MICROSECOND, identifier].append(end)
    frames = []
    for stamp, frame in log:
        ends_here = known.get((stamp // MICROSECOND, frame.id))
        frames.append(Received(ends_here.popleft() if ends_here else stamp - power_on, frame))
    return frames


def _nanos(seconds: npt.NDArray[Any]) -> list[Nanos]:
    return [round(stamp * SECOND) for stamp in seconds.tolist()]
