"""What witnesses report between two cycles: a list to append to, so that reporting costs next to nothing."""

from __future__ import annotations

from hilbed.record.row import Witnessed
from hilbed.types import Reading, Snapshot, Transfer


class Notes:
    """The Witness of sensors and bus; a journal empties it with each cycle."""

    __slots__ = ("readings", "snapshots", "transfers")

    def __init__(self) -> None:
        self.transfers: list[Transfer] = []
        self.readings: list[Witnessed] = []
        self.snapshots: list[Snapshot] = []

    def transfer(self, transfer: Transfer) -> None:
        """Notes a frame that has crossed the bus."""
        self.transfers.append(transfer)

    def reading(self, reading: Reading, beacon: int, true: tuple[float, ...]) -> None:
        """Notes a reading with its true beacon (−1: spurious) and true value (NaN: none)."""
        self.readings.append(Witnessed(reading, beacon, true))

    def snapshot(self, snapshot: Snapshot) -> None:
        """Notes an exposed camera frame; its image must not be written to afterwards."""
        self.snapshots.append(snapshot)

    def clear(self) -> None:
        """Forgets everything; the lists stay the same objects."""
        self.transfers.clear()
        self.readings.clear()
        self.snapshots.clear()
