"""What is written to a drive at boot: its table, what follows from the period, what the scenario sets."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hilbed.can.cob import CONTROLLER_ID
from hilbed.can.codec import bit_length
from hilbed.can.drive_table import DriveTable
from hilbed.can.node import Node
from hilbed.can.objects import Entry, Pdo
from hilbed.clock import MILLISECOND, seconds
from hilbed.types import Nanos

_OFF, _NO_REMOTE = 1 << 31, 1 << 30
_RECEIVE, _TRANSMIT, _MAPPING = 0x1400, 0x1800, 0x200

Step = tuple[Entry, float]
"""An object and the raw value that is written to it."""


def steps(axes: Sequence[Node], period: Nanos) -> Iterator[Step]:
    """Yields everything that is written to a node before it is started, in order; axes: those in it."""
    node, table = axes[0], axes[0].table
    yield from _heartbeat(table, period)
    for write in table.writes:
        yield write, write.value
    for setting in table.period:
        yield setting, setting.raw(seconds(period))
    if table.interpolates:
        yield from _interpolation(period)
    for axis in axes:
        yield from _settings(axis)
    for name, pdo in table.pdos.items():
        yield from _pdo(node, name, pdo)
    for axis in axes:
        yield axis.of("mode"), table.modes[axis.first_mode]
        yield axis.of(table.target), 0


def _settings(axis: Node) -> Iterator[Step]:
    for key, value in axis.settings.items():
        setting = axis.table.settings[key]
        yield setting.of(axis.axis), setting.raw(value)
    if axis.max_speed is not None and "max_velocity" in axis.table.objects:
        yield axis.of("max_velocity"), abs(axis.max_speed * axis.velocity_per_radian)


def _heartbeat(table: DriveTable, period: Nanos) -> Iterator[Step]:
    """The controller's heartbeat comes with its cycles, so a drive waits for three of them at least."""
    patience = max(table.heartbeat.consumer, 3 * period // MILLISECOND)
    yield Entry(index=0x1016, sub=1, type="u32"), CONTROLLER_ID << 16 | min(patience, 0xFFFF)
    yield Entry(index=0x1017, type="u16"), table.heartbeat.drive


def _interpolation(period: Nanos) -> Iterator[Step]:
    """60C2 has one byte and a power of ten; a period that it cannot say exactly is left to 1006."""
    for exponent in (-3, -2, -1, -4, -5, -6):
        mantissa, rest = divmod(period, 10 ** (9 + exponent))
        if not rest and 0 < mantissa <= 255:
            yield Entry(index=0x60C2, sub=2, type="i8"), exponent
            yield Entry(index=0x60C2, sub=1, type="u8"), mantissa
            return


def _pdo(node: Node, name: str, pdo: Pdo) -> Iterator[Step]:
    """Switches a PDO off, describes it, switches it on (CiA 301)."""
    number, sends = int(name[-1]) - 1, name[0] == "t"
    index = (_TRANSMIT if sends else _RECEIVE) + number
    identifier = pdo.cob_id + node.id | (_NO_REMOTE if sends else 0)
    switch = Entry(index=index, sub=1, type="u32")
    yield switch, identifier | _OFF
    yield Entry(index=index, sub=2, type="u8"), pdo.transmission
    if sends and pdo.transmission > 240:
        yield Entry(index=index, sub=5, type="u16"), pdo.event_timer
    if node.table.remappable:
        yield from _mapping(node.table, index + _MAPPING, name)
    yield switch, identifier


def _mapping(table: DriveTable, index: int, pdo: str) -> Iterator[Step]:
    count = Entry(index=index, sub=0, type="u8")
    yield count, 0
    entries = table.mapped(pdo)
    for sub, entry in enumerate(entries, start=1):
        mapped = entry.index << 16 | entry.sub << 8 | bit_length(entry.type)
        yield Entry(index=index, sub=sub, type="u32"), mapped
    yield count, len(entries)
