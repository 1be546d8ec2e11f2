"""One axis of a stand-in: the bench's own firmware behind the numbers of another drive type."""

from __future__ import annotations

from collections.abc import Mapping
from math import tau
from typing import Any

from firmware_sim import Drive
from hilbed.can.codec import scalar
from hilbed.can.drive_table import DriveTable
from hilbed.can.sdo import ABORT, UPLOAD, download_frame
from hilbed.types import Frame, Nanos

NUMBER = 1  # of every inner node: they hang on no bus

# Words of a table in the firmware's own objects: index, type.
_OWN = {
    "controlword": (0x6040, "u16"),
    "statusword": (0x6041, "u16"),
    "mode": (0x6060, "i8"),
    "mode_display": (0x6061, "i8"),
    "target_velocity": (0x60FF, "i32"),
    "velocity_actual": (0x606C, "i32"),
    "position_actual": (0x6064, "i32"),
    "current_actual": (0x6078, "i16"),
    "error_code": (0x603F, "u16"),
}


class InnerAxis:
    """A firmware of its own, read and written by the words of a drive table in that table's numbers.

    stored: what its maker has set, with the encoder's counts a turn (2001) and the rated current (6075, mA).
    """

    def __init__(self, table: DriveTable, axis: int, stored: Mapping[tuple[int, int], Any]) -> None:
        self.drive = Drive(NUMBER, stored=stored)
        counts, units = stored[0x2001, 0], table.units
        per_radian = counts / tau
        ampere = stored[0x6075, 0] / 1e6  # A a number in 6078
        self._scales = {
            "target_velocity": abs(units.velocity_scale(None, axis)) / per_radian,
            "velocity_actual": abs(units.actual_scale(None, axis)) / per_radian,
            "position_actual": abs(units.position_scale(None, axis)) / per_radian,
            "current_actual": ampere / abs(units.amperes(axis)),
        }

    def read(self, t: Nanos, word: str) -> int:
        """Returns an object in the table's numbers."""
        index, data_type = _OWN[word]
        answer = self.ask(t, bytes((UPLOAD, index & 0xFF, index >> 8, 0, 0, 0, 0, 0)))
        (own,) = scalar(data_type).unpack_from(answer, 4)
        return round(own * self._scales[word]) if word in self._scales else int(own)

    def write(self, t: Nanos, word: str, value: int) -> bytes:
        """Stores an object given in the table's numbers; returns the answer of the SDO server."""
        index, data_type = _OWN[word]
        own = round(value / self._scales[word]) if word in self._scales else value
        return self.ask(t, download_frame(NUMBER, index, 0, scalar(data_type).pack(own)).data)

    def ask(self, t: Nanos, request: bytes) -> bytes:
        """Returns the answer to an SDO request."""
        self.drive.on_frame(t, Frame(0x600 + NUMBER, request))
        outbox = self.drive.outbox
        answer = next((frame for frame in outbox if frame.id == 0x580 + NUMBER), None)
        if answer is None:
            return bytes((ABORT, *request[1:4], 0, 0, 0, 8))
        outbox.remove(answer)
        return bytes(answer.data)
