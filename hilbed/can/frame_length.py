"""How many bits a CAN frame takes on the wire: header, data, CRC-15 and the stuff bits between them.

Bosch CAN 2.0 A/B. The header depends on few values and is cached; data and CRC go through tables a byte
at a time, so that a frame with eight bytes costs about a microsecond.
"""

from __future__ import annotations

from functools import lru_cache

from hilbed.types import BusError, Frame

INTERFRAME_BITS = 3
"""Recessive bits that must pass between two frames."""

_TRAILER_BITS = 10  # CRC delimiter, acknowledge slot and delimiter, end of frame: never stuffed
_CRC_BITS = 15
_CRC_POLYNOMIAL = 0x4599


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


def _stuff_table(width: int) -> tuple[int, ...]:
    """Builds entries stuffed << 11 | state << 8 at index state << 8 | value."""
    entries = [0] * (8 << 8)
    for state in range(8):
        for value in range(1 << width):
            after, stuffed = _stuff_bits(state, value, width)
            entries[state << 8 | value] = stuffed << 11 | after << 8
    return tuple(entries)


_CRC = tuple(map(_crc_entry, range(256)))
_STUFF_8 = _stuff_table(8)
_STUFF_7 = _stuff_table(7)
_STATE = 0x700


def crc15(data: bytes, crc: int = 0) -> int:
    """Returns CRC-15/CAN of whole bytes (leading zero bits do not change it)."""
    for byte in data:
        crc = _CRC[crc >> 7 ^ byte] ^ (crc << 8 & 0x7FFF)
    return crc


@lru_cache(maxsize=4096)
def _header(identifier: int, length: int, extended: bool, remote: bool) -> tuple[int, int, int]:
    """Returns what the bits up to the data length code leave behind: length with trailer, CRC, stuffing."""
    if not 0 <= identifier < (1 << 29 if extended else 1 << 11) or length > 8:
        raise BusError(f"no CAN frame: identifier {identifier:#x}, {length} bytes")
    if extended:
        base, low = identifier >> 18, identifier & 0x3FFFF
        bits, width = (((base << 2 | 0b11) << 18 | low) << 1 | remote) << 6 | length, 39
    else:
        bits, width = ((identifier << 1) | remote) << 6 | length, 19
    state, stuffed = _stuff_bits(0, bits, width - 1)  # the state after the start bit, a single dominant one
    return width + _CRC_BITS + _TRAILER_BITS, crc15(bits.to_bytes(5, "big")), stuffed << 11 | state << 8


def frame_bits(frame: Frame) -> int:
    """Returns the bits from start of frame to end of frame, stuff bits included, interframe space not.

    A remote frame's data gives its data length code only. Raises BusError where no such frame can be.
    """
    identifier, data, extended, remote = frame
    length = len(data)
    bits, crc, stuffing = _header(identifier, length, extended, remote)
    state, stuffed = stuffing & _STATE, stuffing >> 11
    if not remote:
        bits += 8 * length
        for byte in data:
            crc = _CRC[crc >> 7 ^ byte] ^ (crc << 8 & 0x7FFF)
            entry = _STUFF_8[state | byte]
            state = entry & _STATE
            stuffed += entry >> 11
    entry = _STUFF_7[state | crc >> 8]
    return bits + stuffed + (entry >> 11) + (_STUFF_8[entry & _STATE | crc & 0xFF] >> 11)
