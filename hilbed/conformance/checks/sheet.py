"""The drive against its data sheet: every object that the EDS promises can be read, at its size."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hilbed.can.sdo import SdoError
from hilbed.can.sdo_aborts import TIMEOUT
from hilbed.conformance.eds import Promise
from hilbed.conformance.result import Result, told
from hilbed.conformance.subject import Subject

_MOST = 5


def sheet(promises: Sequence[Promise], subject: Subject) -> Iterator[Result]:
    """Reads every entry; tells the first ones that are not as promised."""
    broken = [text for promise in promises if (text := _broken(promise, subject))]
    more = f" and {len(broken) - _MOST} more" if len(broken) > _MOST else ""
    note = f"of {len(promises)} readable entries, {len(broken)} are not as promised"
    if broken:
        note += f": {', '.join(broken[:_MOST])}{more}"
    yield told("eds/entries", not broken, note, len(promises) - len(broken), "entries")


def _broken(promise: Promise, subject: Subject) -> str:
    """Returns what is wrong with an entry, empty if nothing."""
    place = f"{promise.object:04X}:{promise.sub:02X}"
    try:
        data = subject.sdo.upload(promise.object, promise.sub)
    except SdoError as error:
        if error.code == TIMEOUT:
            raise
        return f"{place} abort {error.code:08X}"
    if promise.size is not None and len(data) != promise.size:
        return f"{place} has {len(data)} bytes, not {promise.size}"
    return ""
