"""Emergency frames: what a drive says when something went wrong (CiA 301; codes also in 603F of CiA 402)."""

from __future__ import annotations

from struct import Struct
from typing import NamedTuple

from hilbed.can.cob import EMERGENCY
from hilbed.types import Frame

_LAYOUT = Struct("<HB5s")

_CODES = {
    0x2310: "continuous overcurrent",
    0x3210: "DC link overvoltage",
    0x3220: "DC link undervoltage",
    0x7121: "motor blocked",
    0x7305: "encoder",
    0x8130: "heartbeat or life guarding lost",
    0x8210: "PDO too short to be processed",
    0x8600: "homing or positioning",
    0x8611: "following error",
}
_CLASSES = {
    0x00: "error gone",
    0x10: "generic error",
    0x20: "current",
    0x30: "voltage",
    0x40: "temperature",
    0x50: "hardware",
    0x60: "software",
    0x70: "additional modules",
    0x80: "monitoring",
    0x81: "communication",
    0x82: "protocol",
    0x90: "external error",
    0xF0: "additional functions",
    0xFF: "maker's own",
}


class Emergency(NamedTuple):
    """Error code (object 603F), error register (1001), five bytes of the maker."""

    code: int
    register: int
    maker: bytes


def decode(frame: Frame) -> tuple[int, Emergency] | None:
    """Returns the node and what it said, None where the frame is no emergency."""
    node = frame.id - EMERGENCY
    if frame.extended or frame.remote or not 0 < node <= 127 or len(frame.data) != 8:
        return None
    return node, Emergency(*_LAYOUT.unpack(frame.data))


def meaning(code: int) -> str:
    """Returns a short description of an error code, of its class where the code itself is unknown."""
    high = code >> 8
    return _CODES.get(code) or _CLASSES.get(high) or _CLASSES.get(high & 0xF0, "unknown error")
