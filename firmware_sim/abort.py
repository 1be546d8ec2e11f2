"""SDO abort codes (CiA 301, SDO abort transfer)."""

from __future__ import annotations

from enum import IntEnum


class AbortCode(IntEnum):
    TOGGLE = 0x05030000
    TIMEOUT = 0x05040000
    COMMAND = 0x05040001
    UNSUPPORTED_ACCESS = 0x06010000
    WRITE_ONLY = 0x06010001
    READ_ONLY = 0x06010002
    NO_OBJECT = 0x06020000
    NOT_MAPPABLE = 0x06040041
    PDO_LENGTH = 0x06040042
    INCOMPATIBLE = 0x06040043
    LENGTH = 0x06070010
    TOO_LONG = 0x06070012
    TOO_SHORT = 0x06070013
    NO_SUBINDEX = 0x06090011
    INVALID_VALUE = 0x06090030
    TOO_HIGH = 0x06090031
    TOO_LOW = 0x06090032


class Abort(Exception):
    """Ends an SDO transfer with a code that the client gets."""

    def __init__(self, code: AbortCode) -> None:
        super().__init__(code)
        self.code = code
