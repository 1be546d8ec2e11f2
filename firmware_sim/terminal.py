"""The drive's pins as CAN frames: its motor and shaft are simulated somewhere else.

Extended frames, so that they never mix with the drive's own traffic. To the firmware, once a tick: encoder
counts I32, motor current mA I16, supply U8 in quarters of a volt, counter U8. From it: duty I16 (Q15),
bits U8, the counter it answers, and the speed reference in µrad/s I32, for the record. Little-endian.
A frame without data to the firmware switches its power off and on; it is answered likewise. One with a single
byte holds digital inputs (bits of 60FD) that have changed; it is not answered.
"""

from __future__ import annotations

import struct
from collections.abc import Collection
from typing import Final

from firmware_sim.drive import Drive
from firmware_sim.frame import AnyFrame, Frame

TO_FIRMWARE: Final = 0x1FFE0000
FROM_FIRMWARE: Final = 0x1FFE0100
ENABLED: Final = 1
FAULT: Final = 2
TICK_NS: Final = 1_000_000
_PINS = struct.Struct("<ihBB")
_ANSWER = struct.Struct("<hBBi")
_OLD: Final = 128  # a counter that seems to have gone on by so much has gone back
_MAILBOXES: Final = 4096


def micro(speed: float) -> int:
    """Converts a speed (rad/s) to µrad/s as an I32, which clips."""
    return round(1e6 * speed) if -2147.0 <= speed <= 2147.0 else 2147000000 if speed > 0.0 else -2147000000


class Terminal:
    """A drive that is driven by frames alone: `receive` returns what has to be sent after each.

    Frames of the bus wait for the next terminal frame, as a polled loop finds them at the start of its tick;
    what the acceptance filter refuses is not kept. Whatever is in a frame, nothing is raised.
    malformed: terminal frames of another length; lost, repeated: terminal frames by their counter; overrun:
    frames of the bus that had no room any more, as no tick came.
    """

    def __init__(self, node: int) -> None:
        self.malformed = self.lost = self.repeated = self.overrun = 0
        self._node = node
        self._power()

    def _power(self) -> None:
        self._accepted: Collection[int] = ()  # nothing is heard before power-on
        self._drive = Drive(self._node, self._accept)
        self._waiting: list[AnyFrame] = []
        self._counter: int | None = None
        self._t = 0

    def _accept(self, identifiers: Collection[int]) -> None:
        self._accepted = identifiers

    def receive(self, frame: AnyFrame) -> list[Frame]:
        """Takes a frame off the bus; after a terminal frame, the drive's own frames and last the answer."""
        if not frame.extended:
            if frame.id in self._accepted:
                self._keep(frame)
            return []
        if frame.id != TO_FIRMWARE + self._node or frame.remote:
            return []
        if not frame.data:
            self._power()
            return [self._framed(b"")]
        if len(frame.data) == 1:
            self._drive.read(frame.data[0])
            return []
        if len(frame.data) != _PINS.size:
            self.malformed += 1
            return []
        return self._tick(*_PINS.unpack(frame.data))

    def _keep(self, frame: AnyFrame) -> None:
        if len(self._waiting) < _MAILBOXES:
            self._waiting.append(frame)
        else:
            self.overrun += 1

    def _tick(self, counts: int, current: int, supply: int, counter: int) -> list[Frame]:
        if not self._follows(counter):
            self.repeated += 1
            return []
        drive = self._drive
        for frame in self._waiting:
            drive.on_frame(self._t, frame)
        self._waiting.clear()
        duty = drive.tick(self._t, counts, current, supply)
        bits = ENABLED * drive.bridge_enabled | FAULT * drive.faulted
        answer = _ANSWER.pack(duty, bits, counter, micro(drive.speed_ref))
        sent = [*drive.outbox, self._framed(answer)]
        drive.outbox.clear()
        return sent

    def _follows(self, counter: int) -> bool:
        """Moves time on by what the counter says, lost ticks included; False for a frame of the past."""
        if self._counter is not None:
            ticks = (counter - self._counter) & 0xFF
            if not 0 < ticks < _OLD:
                return False
            self.lost += ticks - 1
            self._t += ticks * TICK_NS
        self._counter = counter
        return True

    def _framed(self, data: bytes) -> Frame:
        return Frame(FROM_FIRMWARE + self._node, data, extended=True)
