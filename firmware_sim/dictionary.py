"""The object dictionary at run time: values, and the way in and out that SDO uses."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from firmware_sim.abort import Abort, AbortCode
from firmware_sim.entry import Entry, key
from firmware_sim.objects import OBJECTS
from firmware_sim.rules import RULES

ENTRIES: dict[int, Entry] = {key(o.index, e.sub): e for o in OBJECTS for e in o.entries}
INDICES = frozenset(o.index for o in OBJECTS)


def find(index: int, sub: int) -> Entry:
    """Returns an entry; raises Abort where there is none."""
    entry = ENTRIES.get(key(index, sub))
    if entry is None:
        raise Abort(AbortCode.NO_SUBINDEX if index in INDICES else AbortCode.NO_OBJECT)
    return entry


class ObjectDictionary:
    """Values of every entry for one node.

    `values` (by `key(index, sub)`) is shared with the parts of the firmware that produce and use them;
    `read` and `write` are the guarded way, for a client on the bus. stored: what a reset restores instead of
    the defaults, by index and sub-index; raises Abort where an entry does not exist or does not take it.
    """

    __slots__ = ("_node", "_stored", "values")

    def __init__(self, node: int, stored: Mapping[tuple[int, int], Any] | None = None) -> None:
        self._node = node
        self._stored = {key(*where): value for where, value in (stored or {}).items()}
        for where, value in (stored or {}).items():
            find(*where).check(value)
        self.values: dict[int, Any] = {}
        self.restore(0x0000, 0xFFFF)

    def restore(self, first: int, last: int) -> None:
        """Gives the objects of these indices, both included, their stored values or their defaults."""
        for where, entry in ENTRIES.items():
            if first <= where >> 8 <= last:
                default = entry.default + self._node if entry.relative else entry.default
                default = self._stored.get(where, default)
                # As it would be after a write: a REAL32 has 24 bits.
                self.values[where] = entry.type.unpack(entry.type.pack(default))

    def read(self, index: int, sub: int) -> bytes:
        """Returns the bytes of a value; raises Abort."""
        entry = find(index, sub)
        if not entry.readable:
            raise Abort(AbortCode.WRITE_ONLY)
        return entry.type.pack(self.values[key(index, sub)])

    def writable(self, index: int, sub: int) -> Entry:
        """Returns an entry that a client may write; raises Abort."""
        entry = find(index, sub)
        if not entry.writable:
            raise Abort(AbortCode.READ_ONLY)
        return entry

    def write(self, index: int, sub: int, data: bytes) -> None:
        """Stores a value; raises Abort and leaves everything as it was if it may not be stored."""
        entry = self.writable(index, sub)
        value = entry.type.unpack(data)
        entry.check(value)
        rule = RULES.get(index)
        if rule is not None:
            rule(self.values, index, sub, value)
        self.values[key(index, sub)] = value
