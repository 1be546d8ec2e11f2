"""Another mapping for a PDO, and mappings that must be refused."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from hilbed.can import nmt
from hilbed.can.cob import SYNC_FRAME
from hilbed.can.codec import bit_length
from hilbed.can.objects import Entry
from hilbed.can.sdo import SdoError
from hilbed.clock import MILLISECOND
from hilbed.conformance.result import Result, told, unsupported
from hilbed.conformance.subject import Subject
from hilbed.conformance.tpdo import Tpdo
from hilbed.types import Nanos

PATIENCE: Nanos = 50 * MILLISECOND
_ABSENT = 0x5FFF0010


def remap(subject: Subject) -> Iterator[Result]:
    """The first TPDO with another content; mappings that must be refused."""
    subject.manage(nmt.ENTER_PREOPERATIONAL)
    tpdo = Tpdo(subject, subject.node.table.sends[0])
    status = subject.entry("statusword")
    mode = subject.entry("mode_display")
    tpdo.off()
    try:
        tpdo.map([_mapped(status)])
    except SdoError as error:
        yield unsupported("pdo/remap", f"abort {error.code:08X}")
        return
    for entries in ([status], [mode, status]):
        subject.manage(nmt.ENTER_PREOPERATIONAL)
        tpdo.off()
        tpdo.map([_mapped(entry) for entry in entries])
        tpdo.on()
        subject.manage(nmt.START)
        yield _content(subject, tpdo, entries)
    yield _refused("pdo/remap while it is on", lambda: tpdo.map([_mapped(mode)]))
    tpdo.off()
    yield _refused("pdo/map an object that is not there", lambda: tpdo.map([_ABSENT]))
    speed = subject.entry("velocity_actual")
    yield _refused("pdo/map more than 8 bytes", lambda: tpdo.map([_mapped(speed)] * 3))


def _mapped(entry: Entry) -> int:
    return entry.index << 16 | entry.sub << 8 | bit_length(entry.type)


def _content(subject: Subject, tpdo: Tpdo, entries: Sequence[Entry]) -> Result:
    """Compares a TPDO with what SDO says of the same objects."""
    check = f"pdo/remap to {len(entries)} object{'s' * (len(entries) > 1)}"
    expected = b"".join(
        (subject.read_entry(e) & (1 << bit_length(e.type)) - 1).to_bytes(bit_length(e.type) // 8, "little")
        for e in entries
    )
    subject.link.send(SYNC_FRAME)
    data = subject.link.answer(lambda frame: frame.data if frame.id == tpdo.cob_id else None, PATIENCE)
    if data is None:
        return told(check, False, "no TPDO after SYNC")
    return told(check, data == expected, f"{data.hex(' ')}, by SDO {expected.hex(' ')}")


def _refused(check: str, act: Callable[[], None]) -> Result:
    try:
        act()
    except SdoError as error:
        return told(check, True, f"abort {error.code:08X}")
    return told(check, False, "was taken")
