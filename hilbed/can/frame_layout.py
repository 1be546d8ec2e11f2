"""The bits of a CAN frame one by one, as its transmitter sends them; asked for only where something fails.

0 is dominant, 1 recessive. Bosch CAN 2.0 A/B.
"""

from __future__ import annotations

from collections.abc import Iterable

from hilbed.can.frame_length import crc15
from hilbed.types import Frame

ACKNOWLEDGE = -9
"""Index of the acknowledge slot: its delimiter and seven bits of end of frame follow."""

_TRAILER = [1] * 10  # CRC delimiter, acknowledge slot and delimiter, end of frame


def layout(frame: Frame) -> list[int]:
    """Returns every bit from start of frame to end of frame, stuff bits included."""
    plain = _header(frame)
    if not frame.remote:
        plain += _bits(int.from_bytes(frame.data, "big"), 8 * len(frame.data))
    number = int("".join(map(str, plain)), 2)
    crc = crc15(number.to_bytes(len(plain) // 8 + 1, "big"))  # leading zeros do not change it
    return _stuffed(plain + _bits(crc, 15)) + _TRAILER


def beyond_arbitration(frame: Frame) -> int:
    """Returns the index of the first bit after the arbitration field."""
    return len(_stuffed(_header(frame)[: 33 if frame.extended else 13]))


def _header(frame: Frame) -> list[int]:
    identifier, data, extended, remote = frame
    if extended:
        field = [*_bits(identifier >> 18, 11), 1, 1, *_bits(identifier & 0x3FFFF, 18), remote, 0, 0]
    else:
        field = [*_bits(identifier, 11), remote, 0, 0]
    return [0, *map(int, field), *_bits(len(data), 4)]


def _bits(value: int, width: int) -> list[int]:
    return [value >> place & 1 for place in reversed(range(width))]


def _stuffed(bits: Iterable[int]) -> list[int]:
    """Returns the bits with one of the other level after five of the same."""
    sent: list[int] = []
    run = 0
    for bit in bits:
        run = run + 1 if sent and bit == sent[-1] else 1
        sent.append(bit)
        if run == 5:
            sent.append(1 - bit)
            run = 1
    return sent
