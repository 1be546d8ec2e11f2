"""Terminal frames: the pins of a drive whose firmware is a process elsewhere, as bytes.

Extended identifiers, the node's number added. To the firmware, once a tick: encoder counts I32, current mA
I16, supply U8 (0.25 V), counter U8. From it: duty I16 (Q15), bits U8, the counter answered, speed reference
in µrad/s I32, which some firmware leaves out. No data: the power is switched off and on, and the answer. One
byte to the firmware: digital inputs (bits of 60FD) that have changed, read with the tick that follows.
"""

from __future__ import annotations

import struct
from typing import Final, NamedTuple

from hilbed.types import Frame

TO_FIRMWARE: Final = 0x1FFE0000
FROM_FIRMWARE: Final = 0x1FFE0100
ENABLED, FAULT = 1, 2
_PINS = struct.Struct("<ihBB")
_ANSWER = struct.Struct("<hBBi")
_SHORT = struct.Struct("<hBB")
_NODES = range(1, 128)


class Answer(NamedTuple):
    """What the firmware drives: duty in Q15, bridge on or open, speed reference in µrad/s.

    counter: of the pins that it answers.
    """

    duty: int
    enabled: bool
    fault: bool
    counter: int
    speed_ref: int


def power(node: int) -> Frame:
    """Returns the frame that switches a firmware's power off and on."""
    return Frame(TO_FIRMWARE + node, b"", extended=True)


def pins(node: int, counts: int, current: int, supply: int, counter: int) -> Frame:
    """Returns the frame of one tick: counts (I32), mA (I16), quarters of a volt (U8), counter (U8)."""
    return Frame(TO_FIRMWARE + node, _PINS.pack(counts, current, supply, counter), extended=True)


def inputs(node: int, bits: int) -> Frame:
    """Returns the frame of digital inputs, in the bits of 60FD."""
    return Frame(TO_FIRMWARE + node, bytes((bits,)), extended=True)


def is_terminal(frame: Frame) -> bool:
    """Tells whether a frame stands for pins: it has no place in logs, load or hash."""
    return frame.extended and frame.id & 0x1FFFFE00 == TO_FIRMWARE


def answering(frame: Frame) -> int | None:
    """Returns the number of the node whose firmware sent this frame, None for all other frames."""
    node = frame.id - FROM_FIRMWARE
    return node if frame.extended and not frame.remote and node in _NODES else None


def answer(data: bytes) -> Answer | None:
    """Returns what an answer says, None if it has another length."""
    if len(data) == _ANSWER.size:
        duty, bits, counter, speed_ref = _ANSWER.unpack(data)
    elif len(data) == _SHORT.size:
        (duty, bits, counter), speed_ref = _SHORT.unpack(data), 0
    else:
        return None
    return Answer(duty, bool(bits & ENABLED), bool(bits & FAULT), counter, speed_ref)
