"""Rules of single objects that type and range cannot say. Each raises Abort or does nothing."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from firmware_sim.abort import Abort, AbortCode
from firmware_sim.entry import Entry, key
from firmware_sim.objects import OBJECTS
from firmware_sim.objects.communication import CONSUMERS
from firmware_sim.objects.pdo import (
    MAPPED,
    OFF,
    PDOS,
    RX_MAPPING,
    RX_PARAMETERS,
    TX_MAPPING,
    TX_PARAMETERS,
)

Values = dict[int, Any]
Rule = Callable[[Values, int, int, Any], None]

_EXTENDED = 1 << 29
_ID = 0x7FF
# Identifiers that belong to NMT, SDO, heartbeat and other fixed services (CiA 301, restricted CAN-IDs).
_RESTRICTED = ((0x000, 0x07F), (0x101, 0x180), (0x581, 0x5FF), (0x601, 0x67F), (0x6E0, 0x6FF), (0x701, 0x7FF))
_MAPPABLE: dict[int, Entry] = {key(o.index, e.sub): e for o in OBJECTS for e in o.entries if e.mappable}
_KNOWN = frozenset(key(o.index, e.sub) for o in OBJECTS for e in o.entries)


def _identifier(cob: int) -> None:
    number = cob & _ID
    if cob & _EXTENDED or any(low <= number <= high for low, high in _RESTRICTED):
        raise Abort(AbortCode.INVALID_VALUE)


def history(_values: Values, _index: int, _sub: int, value: int) -> None:
    """1003:0 takes nothing but zero, which clears the history."""
    if value != 0:
        raise Abort(AbortCode.INVALID_VALUE)


def sync(_values: Values, _index: int, _sub: int, value: int) -> None:
    """The drive consumes SYNC; bit 30 would make it the producer."""
    if value & 1 << 30:
        raise Abort(AbortCode.INVALID_VALUE)
    _identifier(value)


def emergency(_values: Values, _index: int, _sub: int, value: int) -> None:
    _identifier(value)


def consumer(values: Values, index: int, sub: int, value: int) -> None:
    """A node is watched once at most; its number is 1 to 127."""
    node = value >> 16
    if node > 127:
        raise Abort(AbortCode.INVALID_VALUE)
    others = (values[key(index, i)] for i in range(1, CONSUMERS + 1) if i != sub)
    if node and value & 0xFFFF and any(other >> 16 == node and other & 0xFFFF for other in others):
        raise Abort(AbortCode.INCOMPATIBLE)


def parameters(values: Values, index: int, sub: int, value: int) -> None:
    """A PDO's identifier changes only while it is switched off (bit 31)."""
    if sub == 1:
        _identifier(value)
        was = values[key(index, 1)]
        if not was & OFF and not value & OFF and (was ^ value) & _ID:
            raise Abort(AbortCode.INVALID_VALUE)
    elif sub == 2 and 240 < value < 254:
        raise Abort(AbortCode.INVALID_VALUE)
    elif sub == 3 and not values[key(index, 1)] & OFF:
        raise Abort(AbortCode.UNSUPPORTED_ACCESS)


def mapping(values: Values, index: int, sub: int, value: int) -> None:
    """Entries change while the PDO is off and sub-index 0 is zero; then sub-index 0 is set."""
    if not values[key(index - 0x200, 1)] & OFF or (sub and values[key(index, 0)]):
        raise Abort(AbortCode.UNSUPPORTED_ACCESS)
    if sub:
        _mapped(value, receive=index < TX_PARAMETERS)
        return
    if value > MAPPED:
        raise Abort(AbortCode.PDO_LENGTH)
    entries = [values[key(index, i)] for i in range(1, value + 1)]
    if not all(entries):
        raise Abort(AbortCode.NO_OBJECT)
    if sum(entry & 0xFF for entry in entries) > 64:
        raise Abort(AbortCode.PDO_LENGTH)


def _mapped(value: int, receive: bool) -> None:
    if value == 0:
        return
    if value >> 8 not in _KNOWN:
        raise Abort(AbortCode.NO_OBJECT)
    entry = _MAPPABLE.get(value >> 8)
    if entry is None or value & 0xFF != entry.type.size * 8 or (receive and not entry.writable):
        raise Abort(AbortCode.NOT_MAPPABLE)


RULES: dict[int, Rule] = {0x1003: history, 0x1005: sync, 0x1014: emergency, 0x1016: consumer}
for _number in range(PDOS):
    RULES[RX_PARAMETERS + _number] = RULES[TX_PARAMETERS + _number] = parameters
    RULES[RX_MAPPING + _number] = RULES[TX_MAPPING + _number] = mapping
