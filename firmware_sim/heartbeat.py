"""Heartbeats: the node's own (1017) and those of the nodes that it relies on (1016)."""

from __future__ import annotations

from typing import Any

from firmware_sim.entry import key
from firmware_sim.objects.communication import CONSUMERS
from firmware_sim.watchdog import MILLISECOND, NEVER, Watchdog


class Producer:
    """Says when the node's own heartbeat is due (ns)."""

    __slots__ = ("_values", "due")

    def __init__(self, values: dict[int, Any]) -> None:
        self._values = values
        self.due = NEVER

    def poll(self, t: int) -> bool:
        if t < self.due:
            return False
        period = self._values[key(0x1017)] * MILLISECOND
        self.due = t + period if period else NEVER
        return bool(period)


class Consumers:
    """Watches other nodes, each from its first heartbeat on; `due` is the next deadline (ns)."""

    __slots__ = ("_dogs", "_silent")

    def __init__(self, values: dict[int, Any]) -> None:
        entries = (values[key(0x1016, i)] for i in range(1, CONSUMERS + 1))
        self._dogs = {entry >> 16: Watchdog(entry & 0xFFFF) for entry in entries if entry >> 16}
        self._silent: set[int] = set()

    @property
    def nodes(self) -> tuple[int, ...]:
        return tuple(self._dogs)

    @property
    def due(self) -> int:
        return min((dog.due for dog in self._dogs.values()), default=NEVER)

    @property
    def all_alive(self) -> bool:
        return not self._silent

    def kick(self, t: int, node: int) -> None:
        self._dogs[node].kick(t)
        self._silent.discard(node)

    def poll(self, t: int) -> bool:
        """Tells once for each node that has fallen silent."""
        lost = {node for node, dog in self._dogs.items() if dog.poll(t)}
        self._silent |= lost
        return bool(lost)
