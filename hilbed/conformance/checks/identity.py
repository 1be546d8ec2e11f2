"""Who the drive says it is, and whether its SDO server refuses what it must."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from hilbed.can.sdo import SdoError
from hilbed.conformance.result import Result, told, unsupported
from hilbed.conformance.subject import Subject

PROFILE = 402
_NO_OBJECT, _READ_ONLY = (0x06020000,), (0x06010002, 0x06010000)
_ABSENT = 0x5FFF  # the last index of the maker's own that nobody uses


def identity(subject: Subject) -> Iterator[Result]:
    """Device type and identity against the table; the modes that the table has among the supported ones."""
    table = subject.node.table
    device_type = subject.sdo.read(0x1000, 0, "u32")
    yield told("identity/profile", device_type & 0xFFFF == PROFILE, f"1000 is {device_type:08X}")
    expected = table.identity
    found = tuple(subject.sdo.read(0x1018, sub, "u32") for sub in (1, 2))
    same = (device_type, *found) == (expected.device_type, expected.vendor, expected.product)
    yield told("identity/table", same, f"vendor {found[0]:X}, product {found[1]:X}; table {table.name}")
    if not subject.has("modes"):
        yield unsupported("identity/modes", "no 6502")
        return
    supported = subject.read("modes")
    lacking = [name for name, number in table.modes.items() if not supported >> number - 1 & 1]
    yield told("identity/modes", not lacking, f"6502 is {supported:X}" + f", lacks {lacking}" * bool(lacking))


def sdo(subject: Subject) -> Iterator[Result]:
    """Aborts for an object that is not there and for one that may not be written."""
    yield _aborts("sdo/unknown object", lambda: subject.sdo.upload(_ABSENT, 0), _NO_OBJECT)
    status = subject.entry("statusword")
    size = 2 if status.type == "u16" else 4
    yield _aborts(
        "sdo/read-only object",
        lambda: subject.sdo.download(status.index, status.sub, bytes(size)),
        _READ_ONLY,
    )


def _aborts(check: str, act: Callable[[], object], codes: tuple[int, ...]) -> Result:
    try:
        act()
    except SdoError as error:
        return told(check, error.code in codes, f"abort {error.code:08X}")
    return told(check, False, "no abort")
