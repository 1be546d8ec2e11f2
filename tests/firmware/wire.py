"""An independent master on a wire without time: the canopen library, joined to one drive by two calls."""

from __future__ import annotations

from functools import cache
from typing import Any

import canopen
from canopen.profiles.p402 import BaseNode402, State402

from firmware_sim import Drive, Frame
from firmware_sim.eds import PATH

MILLISECOND = 1_000_000
NODE = 5
SYNC = 0x80
SUPPLY = 96  # 24 V in quarters


@cache
def sheet(node: int) -> canopen.ObjectDictionary:
    """Returns the data sheet as the library reads it."""
    return canopen.import_od(str(PATH), node)


class Wire(canopen.Network):
    """Hands every message of the master to the drive, and what the drive sends to the master, at once.

    `t` is the bench's time (ns); `sent` is all that the drive has sent so far.
    """

    def __init__(self, node: int = NODE) -> None:
        super().__init__()
        self.drive = Drive(node)
        self.t = 0
        self.counts = self.current = self.duty = 0
        self.supply = SUPPLY
        self.sent: list[Frame] = []
        remote = BaseNode402(node, sheet(node))  # type: ignore[no-untyped-call]
        self.node: Any = self.add_node(remote)

    def send_message(self, can_id: int, data: Any, remote: bool = False) -> None:
        self.drive.on_frame(self.t, Frame(can_id, bytes(data), False, remote))
        self._deliver()

    def run(self, milliseconds: int, counts_per_tick: int = 0) -> None:
        """Ticks the drive, with its wheel turning by so many counts a tick."""
        for _ in range(milliseconds):
            self.duty = self.drive.tick(self.t, self.counts, self.current, self.supply)
            self._deliver()
            self.t += MILLISECOND
            self.counts += counts_per_tick

    def send_sync(self) -> None:
        self.send_message(SYNC, b"")

    def take(self, identifier: int) -> list[bytes]:
        """Returns and forgets what the drive has sent with this identifier."""
        found = [frame.data for frame in self.sent if frame.id == identifier]
        self.sent = [frame for frame in self.sent if frame.id != identifier]
        return found

    def command(self, word: int, target: int = 0) -> None:
        """Sends controlword and target by RPDO1, and the SYNC at which they act."""
        self.send_message(
            0x200 + NODE, word.to_bytes(2, "little") + target.to_bytes(4, "little", signed=True)
        )
        self.send_sync()

    def state(self) -> str:
        """Returns the state that the statusword shows, read by SDO."""
        word = self.node.sdo[0x6041].raw
        (name,) = [name for name, (mask, bits) in State402.SW_MASK.items() if word & mask == bits]
        return str(name)

    def _deliver(self) -> None:
        frames = list(self.drive.outbox)
        self.drive.outbox.clear()
        self.sent += frames
        for frame in frames:
            self.notify(frame.id, bytearray(frame.data), self.t * 1e-9)


def powered() -> Wire:
    """Returns a drive that has booted."""
    wire = Wire()
    wire.run(1)
    return wire


def operational() -> Wire:
    wire = powered()
    wire.node.nmt.state = "OPERATIONAL"
    return wire


def enabled(mode: int = 9) -> Wire:
    """Returns a drive that turns its wheel in this mode."""
    wire = operational()
    wire.node.sdo[0x6060].raw = mode
    for word in (0x06, 0x07, 0x0F):
        wire.command(word)
    return wire
