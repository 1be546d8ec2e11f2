"""How many bits a CAN frame takes on the wire: header, data, CRC-15 and the stuff bits between them.

Bosch CAN 2.0 A/B. What the header leaves behind depends on few values and is cached; data and CRC go through
tables a byte at a time. The stuffing is a machine whose state is level and length of the last run.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TypeAlias

from hilbed.types import BusError, Frame

INTERFRAME_BITS = 3
"""Recessive bits that must pass between two frames."""

_TRAILER_BITS = 10  # CRC delimiter, acknowledge slot and delimiter, end of frame: never stuffed
_CRC_BITS = 15
_CRC_POLYNOMIAL = 0x4599

Row: TypeAlias = "list[tuple[Row, int]]"
"""A state of the stuffing: for each value of the next 8 bits the state after them and the stuff bits added;
at index 256 + value the same for 7 bits (the CRC has 15)."""


def _crc_entry(byte: int) -> int:
    crc = byte << 7
    for _ in range(8):
        crc = (crc << 1) ^ (_CRC_POLYNOMIAL if crc & 0x4000 else 0)
        crc &= 0x7FFF
    return crc


def _stuff_bit(level: int, run: int, bit: int) -> tuple[int, int, int]:
    """Returns level and length of the run after one more bit, and 1 where a stuff bit had to follow."""
    run = run + 1 if bit == level else 1
    return (1 - bit, 1, 1) if run == 5 else (bit, run, 0)


def _stuff_bits(state: int, value: int, width: int) -> tuple[int, int]:
    """Sends `width` bits, the highest first; returns the state after them and the stuff bits added.

    A state is the level of the last bit and the length of its run (1 to 4): 4 level + run − 1.
    """
    level, run, stuffed = state >> 2, (state & 3) + 1, 0
    for position in reversed(range(width)):
        level, run, added = _stuff_bit(level, run, value >> position & 1)
        stuffed += added
    return level << 2 | run - 1, stuffed


def _stuff_rows() -> tuple[Row, ...]:
    """Returns the rows of all states; equal entries are one object, which the processor's cache likes."""
    rows: tuple[Row, ...] = tuple([] for _ in range(8))
    entries = {(state, stuffed): (rows[state], stuffed) for state in range(8) for stuffed in range(3)}
    for state, row in enumerate(rows):
        for width in (8, 7):
            row += (entries[_stuff_bits(state, value, width)] for value in range(1 << width))
    return rows


_CRC = tuple(map(_crc_entry, range(256)))
_ROWS = _stuff_rows()


def crc15(data: bytes, crc: int = 0) -> int:
    """Returns CRC-15/CAN of whole bytes (leading zero bits do not change it)."""
    for byte in data:
        crc = _CRC[crc >> 7 ^ byte] ^ (crc << 8 & 0x7FFF)
    return crc


@lru_cache(maxsize=4096)
def _header(identifier: int, length: int, extended: bool, remote: bool) -> tuple[int, int, Row]:
    """Returns what the bits up to the data length code leave behind.

    Bits of the frame without those that stuffing of data and CRC will add, CRC, state of the stuffing.
    """
    if not 0 <= identifier < (1 << 29 if extended else 1 << 11) or length > 8:
        raise BusError(f"no CAN frame: identifier {identifier:#x}, {length} bytes")
    if extended:
        base, low = identifier >> 18, identifier & 0x3FFFF
        bits, width = (((base << 2 | 0b11) << 18 | low) << 1 | remote) << 6 | length, 39
    else:
        bits, width = ((identifier << 1) | remote) << 6 | length, 19
    state, stuffed = _stuff_bits(0, bits, width - 1)  # the state after the start bit, a single dominant one
    rest = _CRC_BITS + _TRAILER_BITS + (0 if remote else 8 * length)
    return width + stuffed + rest, crc15(bits.to_bytes(5, "big")), _ROWS[state]


def frame_bits(frame: Frame) -> int:
    """Returns the bits from start of frame to end of frame, stuff bits included, interframe space not.

    A remote frame's data gives its data length code only. Raises BusError where no such frame can be.
    """
    identifier, data, extended, remote = frame
    bits, crc, row = _header(identifier, len(data), extended, remote)
    if not remote:
        for byte in data:
            crc = _CRC[crc >> 7 ^ byte] ^ (crc << 8 & 0x7FFF)
            row, stuffed = row[byte]
            bits += stuffed
    row, stuffed = row[256 | crc >> 8]
    return bits + stuffed + row[crc & 0xFF][1]
