"""A stand-in for a drive of another type: the bench's own firmware, speaking as that drive's table says.

Objects, PDOs, units and the number of axes are the table's data. What the table does not name is answered
as the bench's own drive would, for all axes at once.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from struct import Struct
from typing import Any

from hilbed.build.inner import NUMBER, InnerAxis
from hilbed.can.cob import EMERGENCY, HEARTBEAT, NMT, SDO_ANSWER, SDO_REQUEST, SYNC
from hilbed.can.codec import STRUCT_CODES, bit_length, scalar
from hilbed.can.drive_table import DriveTable
from hilbed.can.nmt import START
from hilbed.can.objects import Object
from hilbed.can.sdo import ABORT, DOWNLOAD, UPLOAD
from hilbed.clock import MILLISECOND
from hilbed.plant.specs import Machine
from hilbed.types import Frame, Nanos

_READ_ONLY, _NOT_MAPPABLE = 0x06010002, 0x06040041
_WRITTEN = ("controlword", "mode", "target_velocity")
_MAPPINGS = (0x1600, 0x1A00)
_SYNCHRONOUS = 240
_RATED = 3360  # mA
_COUNTS = 66_000
_IN_COUNTS = {0x607F: 210_000, 0x6083: 105_000, 0x6084: 105_000, 0x6085: 525_000}
"""Highest speed and ramps for an encoder of so many counts a turn."""
_HEAD = Struct("<BHBI")


class StandIn:
    """One node; `axes` are its motors' sides, each to be ticked once a millisecond, in their order."""

    def __init__(self, node: int, table: DriveTable, stored: Mapping[tuple[int, int], Any]) -> None:
        self._node = node
        self._table = table
        self._stored = stored
        self._operational = False
        self._orders: list[tuple[str, bytes]] = []  # RPDOs that wait for SYNC
        self._due: dict[str, Nanos] = {}
        self._inner = [InnerAxis(table, axis, stored) for axis in range(1, table.axes + 1)]
        self.axes = [Side(self, inner, first=not k) for k, inner in enumerate(self._inner)]
        self.outbox: list[Frame] = []
        self._rpdos = {table.pdos[name].cob_id + node: name for name in table.receives}
        self._objects = dict(self._addressed())

    def _addressed(self) -> Iterator[tuple[tuple[int, int], tuple[str, Object, Sequence[int]]]]:
        """Yields each entry of the table with its word, its object and the axes it belongs to."""
        everyone = range(1, self._table.axes + 1)
        for word, entry in self._table.objects.items():
            for axis in everyone if entry.per_axis == "sub" else (1,):
                whose = (axis,) if entry.per_axis == "sub" else everyone
                yield (entry.index, entry.of(axis).sub), (word, entry, whose)

    # ---- frames

    def on_frame(self, t: Nanos, frame: Frame) -> None:
        """Takes a frame off the bus."""
        identifier, data, extended, remote = frame
        if extended or remote:
            return
        if identifier == SDO_REQUEST + self._node and len(data) == 8:
            self.outbox.append(Frame(SDO_ANSWER + self._node, self._answer(t, data)))
        elif identifier == NMT and len(data) == 2 and data[1] in (0, self._node):
            self._forward(t, Frame(NMT, bytes((data[0], NUMBER))))
            self._operational = data[0] == START
            self._due = {name: t for name in self._table.sends if self._table.pdos[name].event_timer}
        elif identifier == SYNC:
            self._sync(t, frame)
        elif identifier in self._rpdos and self._operational:
            self._order(t, self._rpdos[identifier], data)
        elif HEARTBEAT < identifier <= HEARTBEAT + 127:
            self._forward(t, frame)

    def _forward(self, t: Nanos, frame: Frame) -> None:
        for inner in self._inner:
            inner.drive.on_frame(t, frame)

    def _sync(self, t: Nanos, frame: Frame) -> None:
        """Samples what is sent at SYNC; then waiting orders act."""
        if self._operational:
            for name in self._table.sends:
                if self._table.pdos[name].transmission <= _SYNCHRONOUS:
                    self.outbox.append(self._tpdo(t, name))
        self._forward(t, frame)
        for name, data in self._orders:
            self._obey(t, name, data)
        self._orders.clear()

    def _order(self, t: Nanos, name: str, data: bytes) -> None:
        if self._table.pdos[name].transmission <= _SYNCHRONOUS:
            self._orders.append((name, data))
        else:
            self._obey(t, name, data)

    def _obey(self, t: Nanos, name: str, data: bytes) -> None:
        values = self._table.values(name)
        layout = Struct("<" + "".join(STRUCT_CODES[value.type] for value in values))
        if len(data) != layout.size:
            return
        for value, number in zip(values, layout.unpack(data), strict=True):
            for inner in self._inner if value.axis == 0 else (self._inner[value.axis - 1],):
                inner.write(t, value.word, number)

    def _tpdo(self, t: Nanos, name: str) -> Frame:
        values = self._table.values(name)
        numbers = [self._inner[max(value.axis, 1) - 1].read(t, value.word) for value in values]
        layout = Struct("<" + "".join(STRUCT_CODES[value.type] for value in values))
        return Frame(self._table.pdos[name].cob_id + self._node, layout.pack(*numbers))

    # ---- objects

    def _answer(self, t: Nanos, request: bytes) -> bytes:
        command, index, sub, _ = _HEAD.unpack(request)
        known = self._objects.get((index, sub))
        identity = self._identity(index, sub)
        if command & 0xE0 == UPLOAD and known is not None:
            return self._upload(t, request, *known)
        if command & 0xE0 == UPLOAD and identity is not None:
            return bytes((0x43, *request[1:4])) + identity.to_bytes(4, "little")
        if command & 0xE0 == DOWNLOAD and known is not None:
            return self._download(t, request, *known)
        if command & 0xE0 == DOWNLOAD and index & 0xFE00 in _MAPPINGS:
            return _abort(request, _NOT_MAPPABLE)
        if 0x1400 <= index < 0x1C00 and command & 0xE0 == DOWNLOAD:
            return bytes((0x60, *request[1:4], 0, 0, 0, 0))  # PDOs are as they are
        answers = [inner.ask(t, request) for inner in self._inner]
        return answers[0]

    def _identity(self, index: int, sub: int) -> int | None:
        identity = self._table.identity
        return {
            (0x1000, 0): identity.device_type,
            (0x1018, 1): identity.vendor,
            (0x1018, 2): identity.product,
        }.get((index, sub))

    def _upload(self, t: Nanos, request: bytes, word: str, entry: Object, axes: Sequence[int]) -> bytes:
        size = bit_length(entry.type) // 8
        parts = [
            self._inner[axis - 1].read(t, word) for axis in (axes if entry.per_axis == "half" else axes[:1])
        ]
        width = size // len(parts)
        mask = (1 << 8 * width) - 1
        data = b"".join((part & mask).to_bytes(width, "little") for part in parts)
        return bytes((0x43 | 4 - size << 2, *request[1:4])) + data.ljust(4, b"\0")

    def _download(self, t: Nanos, request: bytes, word: str, entry: Object, axes: Sequence[int]) -> bytes:
        if word not in _WRITTEN:
            return _abort(request, _READ_ONLY)
        (value,) = scalar(entry.type).unpack_from(request, 4)
        answers = [self._inner[axis - 1].write(t, word, value) for axis in axes]
        return bytes((answers[0][0], *request[1:4])) + answers[0][4:]

    # ---- time

    def poll(self, t: Nanos) -> None:
        """Does what is due, and sends what the inner drives have said meanwhile."""
        for name, due in self._due.items():
            if t >= due and self._operational:
                self._due[name] = t + self._table.pdos[name].event_timer * MILLISECOND
                self.outbox.append(self._tpdo(t, name))
        for k, inner in enumerate(self._inner):
            for frame in inner.drive.outbox:
                service = frame.id - NUMBER
                if service == EMERGENCY or (service == HEARTBEAT and not k):
                    self.outbox.append(Frame(service + self._node, frame.data))
            inner.drive.outbox.clear()


class Side:
    """One axis of a stand-in, with the pins of a firmware; the first one carries the node."""

    def __init__(self, node: StandIn, inner: InnerAxis, first: bool) -> None:
        self._standin = node
        self._inner = inner
        self._first = first

    @property
    def outbox(self) -> list[Frame]:
        """What the node has to say."""
        return self._standin.outbox

    def on_frame(self, t: Nanos, frame: Frame) -> None:
        """Takes a frame off the bus, for the whole node."""
        self._standin.on_frame(t, frame)

    def tick(self, t: Nanos, counts: int, current: int, supply: int) -> int:
        """Runs the axis's tick and returns the duty in Q15."""
        if self._first:
            self._standin.poll(t)
        return self._inner.drive.tick(t, counts, current, supply)

    def read(self, inputs: int) -> None:
        """Has no digital inputs that its table knows."""

    @property
    def bridge_enabled(self) -> bool:
        """False: the chopper is open."""
        return self._inner.drive.bridge_enabled

    @property
    def speed_ref(self) -> float:
        """What the speed loop follows, rad/s in the encoder's direction."""
        return self._inner.drive.speed_ref


def plate(machine: Machine) -> dict[tuple[int, int], float]:
    """Returns what a drive's maker has stored of encoder and motor, by index and sub-index."""
    motor, scale = machine.motor, machine.encoder.resolution / _COUNTS
    return {
        (0x2001, 0): machine.encoder.resolution,
        (0x2012, 1): motor.resistance,
        (0x2012, 2): motor.back_emf * machine.gear.ratio,
        (0x6075, 0): _RATED,
        **{(index, 0): round(scale * value) for index, value in _IN_COUNTS.items()},
    }


def _abort(request: bytes, code: int) -> bytes:
    return bytes((ABORT, *request[1:4])) + code.to_bytes(4, "little")
