"""Between values and the bytes of CANopen: little endian, every PDO mapping compiled once to `struct`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from struct import Struct
from typing import Literal, TypeAlias

DataType: TypeAlias = Literal["i8", "u8", "i16", "u16", "i32", "u32", "i64", "u64", "f32", "f64"]

STRUCT_CODES: dict[str, str] = {
    "i8": "b",
    "u8": "B",
    "i16": "h",
    "u16": "H",
    "i32": "i",
    "u32": "I",
    "i64": "q",
    "u64": "Q",
    "f32": "f",
    "f64": "d",
}


def scalar(data_type: str) -> Struct:
    """Returns the layout of one object's value."""
    return Struct("<" + STRUCT_CODES[data_type])


def bit_length(data_type: str) -> int:
    """Returns the length of a mapped object in bits."""
    return 8 * scalar(data_type).size


def limits(data_type: str) -> tuple[int, int]:
    """Returns the smallest and the largest value of an integer type."""
    bits = bit_length(data_type)
    return (-(1 << bits - 1), (1 << bits - 1) - 1) if data_type[0] == "i" else (0, (1 << bits) - 1)


def _code(name: str, data_type: str) -> str:
    return STRUCT_CODES[data_type] if name else f"{scalar(data_type).size}x"


class PdoCodec:
    """One PDO: `fields` are (name, type) in the order of the mapping, without a name where nobody looks.

    `pack(*values)` and `unpack(data)` are those of `struct`, for the hot path: unpack raises struct.error
    where the length is not `size`.
    """

    __slots__ = ("_struct", "names", "pack", "size", "unpack")

    def __init__(self, fields: Sequence[tuple[str, str]]) -> None:
        self.names = tuple(name for name, _ in fields if name)
        self._struct = Struct("<" + "".join(_code(*field) for field in fields))
        self.size = self._struct.size
        self.pack = self._struct.pack
        self.unpack = self._struct.unpack

    def encode(self, values: Mapping[str, float]) -> bytes:
        """Returns the PDO's bytes for values by name."""
        return self.pack(*(values[name] for name in self.names))

    def decode(self, data: bytes) -> dict[str, float]:
        """Returns the values by name."""
        return dict(zip(self.names, self.unpack(data), strict=True))
