"""CANopen's static data types: code in an EDS, bytes on the wire, range."""

from __future__ import annotations

import math
import struct
from typing import Any, NamedTuple

from firmware_sim.abort import Abort, AbortCode

LONGEST_TEXT = 32


class DataType(NamedTuple):
    """code: that of CiA 301; format: little-endian `struct` letter, empty for text."""

    code: int
    format: str

    @property
    def size(self) -> int:
        """Bytes of a value; for text the most that are kept."""
        return struct.calcsize("<" + self.format) if self.format else LONGEST_TEXT

    def pack(self, value: Any) -> bytes:
        """Returns the value's bytes on the wire."""
        return struct.pack("<" + self.format, value) if self.format else value.encode("ascii")

    def unpack(self, data: bytes) -> Any:
        """Returns the value of exactly as many bytes as the type has.

        Raises Abort for a wrong length, text that is not printable, a number that is not finite.
        """
        if not self.format:
            return _text(data)
        if len(data) != self.size:
            raise Abort(AbortCode.TOO_LONG if len(data) > self.size else AbortCode.TOO_SHORT)
        value = struct.unpack("<" + self.format, data)[0]
        if not math.isfinite(value):
            raise Abort(AbortCode.INVALID_VALUE)
        return value


def _text(data: bytes) -> str:
    if len(data) > LONGEST_TEXT:
        raise Abort(AbortCode.TOO_LONG)
    if not all(0x20 <= byte <= 0x7E for byte in data):
        raise Abort(AbortCode.INVALID_VALUE)
    return data.decode("ascii")


I8 = DataType(0x02, "b")
I16 = DataType(0x03, "h")
I32 = DataType(0x04, "i")
U8 = DataType(0x05, "B")
U16 = DataType(0x06, "H")
U32 = DataType(0x07, "I")
REAL32 = DataType(0x08, "f")
TEXT = DataType(0x09, "")
