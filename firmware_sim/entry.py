"""What an object dictionary is made of: objects and their entries."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

from firmware_sim.abort import Abort, AbortCode
from firmware_sim.datatypes import U8, DataType

VAR, ARRAY, RECORD = 7, 8, 9


def key(index: int, sub: int = 0) -> int:
    """Returns the number under which a value is kept: index and sub-index in one integer."""
    return index << 8 | sub


class Entry(NamedTuple):
    """One sub-index: type, access ("ro", "wo", "rw", "const"), default and the values it takes.

    low, high: inclusive, None for the type's own; choices: the only values, if any;
    mappable: may be part of a PDO; relative: the node's number is added to the default.
    """

    sub: int
    name: str
    type: DataType
    access: str
    default: Any = 0
    low: float | None = None
    high: float | None = None
    choices: tuple[int, ...] = ()
    mappable: bool = False
    relative: bool = False

    @property
    def readable(self) -> bool:
        return self.access != "wo"

    @property
    def writable(self) -> bool:
        return "w" in self.access

    def check(self, value: Any) -> None:
        """Raises Abort where the value is out of range."""
        if self.low is not None and value < self.low:
            raise Abort(AbortCode.TOO_LOW)
        if self.high is not None and value > self.high:
            raise Abort(AbortCode.TOO_HIGH)
        if self.choices and value not in self.choices:
            raise Abort(AbortCode.INVALID_VALUE)


@dataclass(frozen=True)
class Object:
    """One index: kind as in an EDS (VAR 7, ARRAY 8, RECORD 9) and its entries."""

    index: int
    name: str
    kind: int
    entries: tuple[Entry, ...]


def var(index: int, name: str, type: DataType, access: str, default: Any = 0, **more: Any) -> Object:
    """Returns an object with one value; `more` are further fields of its Entry."""
    return Object(index, name, VAR, (Entry(0, name, type, access, default, **more),))


def record(index: int, name: str, *entries: Entry, kind: int = RECORD) -> Object:
    """Returns an object whose sub-index 0 tells its highest sub-index."""
    count = Entry(0, "Highest sub-index supported", U8, "const", entries[-1].sub)
    return Object(index, name, kind, (count, *entries))
