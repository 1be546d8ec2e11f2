"""Nodes on their way back from bus-off: 128 times 11 recessive bits (ISO 11898-1)."""

from __future__ import annotations

from hilbed.can.port import Port
from hilbed.types import Nanos

OCCURRENCES, RUN_BITS = 128, 11


class Recovery:
    """Counts recessive bits for every node that wants to come back; bit: ns."""

    def __init__(self, bit: Nanos) -> None:
        self._run = RUN_BITS * bit
        self._left: dict[Port, int] = {}
        self._begun: dict[Port, Nanos] = {}

    def __len__(self) -> int:
        return len(self._left)

    def begin(self, t: Nanos, port: Port) -> None:
        """Starts to count for a node, which is known to be bus-off."""
        if port not in self._left:
            self._left[port], self._begun[port] = OCCURRENCES, t

    def forget(self, port: Port) -> None:
        """Gives a node up."""
        self._left.pop(port, None)
        self._begun.pop(port, None)

    def interrupted(self, quiet: Nanos, start: Nanos) -> None:
        """Takes account of a frame: the bus was recessive from `quiet` to its `start`."""
        for port, left in self._left.items():
            self._left[port] = left - max(0, start - max(quiet, self._begun[port])) // self._run

    def next(self, quiet: Nanos) -> tuple[Nanos, Port] | None:
        """Returns who is back first and when, if the bus stays recessive since `quiet`; None: nobody."""
        times = [
            (max(quiet, self._begun[port]) + left * self._run, port.number, port)
            for port, left in self._left.items()
        ]
        if not times:
            return None
        t, _, port = min(times)
        return t, port
