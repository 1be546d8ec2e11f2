"""The other end of a gateway, without any driver: lists of frames, and a switch that loses the bus."""

from __future__ import annotations

from hilbed.can.counts import Counts
from hilbed.types import BusError, Frame


class FarBus:
    """sent: what went out; incoming: what the next poll returns; lost: why nothing works any more."""

    name = "far bus"

    def __init__(self) -> None:
        self.counts = Counts()
        self.sent: list[Frame] = []
        self.incoming: list[Frame] = []
        self.lost = ""
        self.purged = 0

    def send(self, frame: Frame) -> None:
        if self.lost:
            raise BusError(f"{self.name}: lost while sending: {self.lost}")
        self.sent.append(frame)

    def poll(self) -> list[Frame]:
        if self.lost:
            raise BusError(f"{self.name}: lost while receiving: {self.lost}")
        frames, self.incoming = self.incoming, []
        return frames

    def wait(self, timeout: float) -> list[Frame]:
        assert timeout > 0
        return self.poll()

    def purge(self) -> None:
        self.purged += 1
