"""log.mcap: the whole run for Foxglove, Rerun and PlotJuggler, with frames, images and events."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from struct import pack
from typing import NamedTuple, Protocol

import numpy as np

from hilbed.clock import SECOND, nanos
from hilbed.record import messages
from hilbed.record.channels import Channels
from hilbed.record.cyclelog import CycleLog
from hilbed.record.disk import GrowingFile
from hilbed.record.rounds import Rounds
from hilbed.record.row import Batch, Row, Witnessed
from hilbed.scene import BeaconSpec
from hilbed.types import Array, Innovation, Nanos, Snapshot


class Disturbance(Protocol):
    """What the log needs of a disturbance's block in the scenario: start s, length s or None for good."""

    @property
    def kind(self) -> str: ...
    @property
    def start(self) -> float: ...
    @property
    def length(self) -> float | None: ...


class Setting(NamedTuple):
    """What is known before the run: beacons, reference path (m, m), the robot's radius (m).

    events: what is to happen when, in order of time; scenario: text of the resolved scenario, attached to
    the log.
    """

    beacons: Sequence[BeaconSpec] = ()
    path: Sequence[tuple[float, float]] = ()
    radius: float = 0.2
    events: Sequence[tuple[Nanos, str]] = ()
    scenario: str = ""


TAIL = pack("<BQI", 0x0F, 4, 0) + pack("<BQQQI", 0x02, 20, 0, 0, 0) + b"\x89MCAP0\r\n"
"""The end of an MCAP file without an index: data end, footer, magic bytes."""


class McapLog:
    """A sink that writes every signal, frame and image; log time is t + `offset` (ns), never negative.

    Every batch goes to the disk as a whole chunk, and the file is a whole one after each: a run that is
    killed loses the last batch at most, and the index. The same run gives the same bytes.
    """

    def __init__(self, path: Path, offset: Nanos = 0, setting: Setting | None = None) -> None:
        self._offset = offset
        self._file = GrowingFile(path, TAIL)
        self._channels = Channels(self._file)
        self._cycles = CycleLog(self._channels, offset)
        self._rounds = Rounds()
        self._tick_names: list[str] = []
        self._open(setting or Setting())

    def _open(self, setting: Setting) -> None:
        from hilbed.record import scenery

        self._scenery = scenery
        channels = self._channels
        self._log_frame = channels.ros("/can", messages.FRAME)
        self._log_nis = channels.numbers("/nis", "Nis", {"": ("value", "dof", "accepted")})
        self._log_scene = channels.typed("/scene", "SceneUpdate")
        self._log_event = channels.typed("/events", "Log")
        self._events = list(setting.events)
        if setting.scenario:
            channels.attach("scenario.yaml", setting.scenario)
        self._log_scene(scenery.scene(0, setting.beacons, setting.path, setting.radius), log_time=0)

    def take(self, batch: Batch) -> None:
        self._note_transfers(batch)
        for witnessed in batch.readings:
            self._note_reading(witnessed)
        for snapshot in batch.snapshots:
            self._note_snapshot(snapshot)
        for ticks in batch.ticks:
            self._note_ticks(ticks)
        for row in batch.rows:
            self._note_row(row)
        self._cycles.log(batch.rows)
        self._channels.flush()
        self._file.check()

    def close(self) -> None:
        """Writes the index; raises RecordError if the disk was full, what was written stays readable."""
        self._file.finish()
        self._channels.close()
        self._file.close()

    def _note_row(self, row: Row) -> None:
        for innovation in row.innovations:
            self._note_innovation(innovation)
        while self._events and self._events[0][0] <= row.t:
            at, message = self._events.pop(0)
            at += self._offset
            self._log_event(self._scenery.event(at, message), log_time=at)

    def _note_innovation(self, innovation: Innovation) -> None:
        t, nis, dof, accepted = innovation
        self._log_nis(t + self._offset, nis, dof, accepted)

    def _note_transfers(self, batch: Batch) -> None:
        log, offset, message = self._log_frame, self._offset, messages.frame_message
        lost = self._rounds.lost(batch.transfers)
        for transfer, waited in zip(batch.transfers, lost, strict=True):
            log(message(transfer, waited), max(transfer.end + offset, 0))

    def _note_reading(self, witnessed: Witnessed) -> None:
        (kind, t, delivered, value, _, _), beacon, true = witnessed
        size = f"[{len(value)}]" if len(value) > 1 else ""
        fields = ("exposure", "delivered", "beacon", f"measured{size}", f"true{size}")
        log = self._channels.numbers(f"/reading/{kind}", kind.capitalize(), {"": fields})
        true = (*true, *[float("nan")] * len(value))[: len(value)]
        log(t + self._offset, t / SECOND, delivered / SECOND, beacon, *value, *true)

    def _note_snapshot(self, snapshot: Snapshot) -> None:
        stamp = snapshot.t + self._offset
        log = self._channels.typed("/camera/image", "RawImage")
        log(self._scenery.image(stamp, snapshot), log_time=stamp)
        log = self._channels.typed("/camera/detections", "ImageAnnotations")
        log(self._scenery.detections(stamp, snapshot), log_time=stamp)

    def _note_ticks(self, ticks: Mapping[str, Array]) -> None:
        if not self._tick_names:
            self._tick_names = sorted(name for name in ticks if name.startswith("tick/drive/"))
            self._log_tick = self._channels.rows("/ticks", "Tick", _grouped(self._tick_names))
        stamps = np.rint(ticks["tick/t"] * SECOND).astype(np.int64) + self._offset
        self._log_tick(stamps, np.column_stack([ticks[name] for name in self._tick_names]))


def events(disturbances: Sequence[Disturbance]) -> list[tuple[Nanos, str]]:
    """Returns when each disturbance begins and ends, in order of time."""
    begin = [(nanos(each.start), f"{each.kind} begins") for each in disturbances]
    end = [
        (nanos(each.start + each.length), f"{each.kind} ends")
        for each in disturbances
        if each.length is not None
    ]
    return sorted(begin + end)


def _grouped(names: Sequence[str]) -> dict[str, list[str]]:
    """Returns the fields of each drive from sorted names such as tick/drive/left/speed."""
    groups: dict[str, list[str]] = {}
    for name in names:
        _, _, drive, field = name.split("/")
        groups.setdefault(drive, []).append(field)
    return groups
