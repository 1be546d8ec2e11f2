"""Errors: error register, error code, history and what the EMCY producer has to say (CiA 301)."""

from __future__ import annotations

import struct
from enum import IntEnum
from typing import Any, Final

from firmware_sim.entry import key
from firmware_sim.objects.communication import HISTORY

_REGISTER, _COUNT, _CODE = key(0x1001), key(0x1003, 0), key(0x603F)
_FRAME = struct.Struct("<HB5x")
GENERIC: Final = 1
RESET: Final = 0x0000


class ErrorCode(IntEnum):
    OVERCURRENT = 0x2310
    UNDERVOLTAGE = 0x3220
    COMMUNICATION = 0x8100  # SYNC lost, or the node was taken out of operation
    HEARTBEAT_LOST = 0x8130
    PDO_TOO_SHORT = 0x8210
    HOMING = 0x8600  # of the positioning: no home was found in time
    FOLLOWING = 0x8611  # the axis does not keep up with its position demand


# Bit of the error register that an error sets besides the generic one.
_BITS: dict[ErrorCode, int] = {
    ErrorCode.OVERCURRENT: 2,
    ErrorCode.UNDERVOLTAGE: 4,
    ErrorCode.COMMUNICATION: 16,
    ErrorCode.HEARTBEAT_LOST: 16,
    ErrorCode.PDO_TOO_SHORT: 16,
    ErrorCode.HOMING: 32,
    ErrorCode.FOLLOWING: 32,
}


class Errors:
    """What is wrong now (`active`, oldest first); `pending` holds EMCY contents still to be sent.

    `pending` stays the same list, so that others may keep it.
    """

    __slots__ = ("_values", "active", "pending")

    def __init__(self, values: dict[int, Any]) -> None:
        self._values = values
        self.active: list[ErrorCode] = []
        self.pending: list[bytes] = []

    def set(self, code: ErrorCode) -> None:
        """Reports an error once, until it is cleared."""
        if code in self.active:
            return
        self.active.append(code)
        self._remember(code)
        self._update(code)

    def clear(self, *codes: ErrorCode) -> None:
        """Takes errors back; tells the bus if one of them was active."""
        left = [code for code in self.active if code not in codes]
        if len(left) < len(self.active):
            self.active = left
            self._update(RESET)

    def _remember(self, code: int) -> None:
        values = self._values
        count = min(values[_COUNT] + 1, HISTORY)
        for i in range(count, 1, -1):
            values[key(0x1003, i)] = values[key(0x1003, i - 1)]
        values[key(0x1003, 1)] = code
        values[_COUNT] = count

    def forget(self) -> None:
        """Empties the history (a client wrote zero to 1003:0)."""
        for i in range(HISTORY + 1):
            self._values[key(0x1003, i)] = 0

    def restore(self) -> None:
        """Shows what is active again after the dictionary got its defaults."""
        register = GENERIC if self.active else 0
        for active in self.active:
            register |= _BITS[active]
        self._values[_REGISTER] = register
        self._values[_CODE] = self.active[-1] if self.active else 0

    def _update(self, code: int) -> None:
        self.restore()
        self.pending.append(_FRAME.pack(code, self._values[_REGISTER]))
        del self.pending[:-HISTORY]
