"""One drive in operation: what it said last and what it is told, in raw units."""

from __future__ import annotations

from collections.abc import Callable
from math import nan
from typing import Any

from hilbed.can.codec import limits
from hilbed.can.node import Node
from hilbed.types import DriveSignals, Nanos

STATUS, VELOCITY, POSITION, CURRENT, UNUSED = range(5)
_SLOTS = {
    "statusword": STATUS,
    "velocity_actual": VELOCITY,
    "position_actual": POSITION,
    "current_actual": CURRENT,
}
STATE_BITS = 0x6F
"""Of the statusword: those that tell the states apart."""
ENABLED_BITS = 0x27  # what boot leaves behind

Route = tuple["Axis", Callable[[bytes], tuple[Any, ...]], tuple[int, ...], bool]
"""Where a TPDO goes: axis, how to unpack it, the slot of each of its values, whether a position is in it."""


class Axis:
    """State of one drive: raw `values` by slot, when it was heard, its target (`raw`, `speed_ref`).

    state: bits of the statusword that tell states apart; fresh: number of the SYNC that the last position
    answered; position: raw, at the last complete set; heard, alive: when its last PDO, its last heartbeat
    came; silent: since when it is and of what, empty if not; late: how often a SYNC was not answered within
    its cycle; misfits: since when, and how long (bytes), each PDO has come that is not as it was mapped.
    """

    __slots__ = (
        "_actual",
        "_amperes",
        "_limits",
        "_velocity",
        "alive",
        "fresh",
        "heard",
        "late",
        "misfits",
        "node",
        "position",
        "radians_per_count",
        "raw",
        "silent",
        "speed_ref",
        "state",
        "values",
    )

    def __init__(self, node: Node) -> None:
        table = node.table
        self.node = node
        self.values: list[Any] = [ENABLED_BITS, nan, 0, nan, 0]
        self.state = ENABLED_BITS
        self.fresh = 0
        self.position: int | None = None
        self.heard: Nanos = 0
        self.alive: Nanos = 0
        self.silent = ""
        self.late = 0
        self.misfits: dict[int, tuple[Nanos, int]] = {}
        self.speed_ref = 0.0
        self.raw = 0
        self.radians_per_count = 1.0 / node.counts_per_radian
        self._velocity = node.velocity_per_radian
        self._actual = node.actual_per_radian
        self._amperes = node.amperes
        self._limits = limits(table.objects[table.target].parts(node.axis)[0][1])

    def routes(self) -> dict[int, Route]:
        """Returns where each of the drive's TPDOs goes, by identifier."""
        routes: dict[int, Route] = {}
        for name, pdo in self.node.table.pdos.items():
            if name[0] == "t":
                codec = self.node.table.codec(name, self.node.axis)
                slots = tuple(_SLOTS.get(word, UNUSED) for word in codec.names)
                if codec.names:
                    routes[pdo.cob_id + self.node.id] = self, codec.unpack, slots, POSITION in slots
        return routes

    def ask(self, speed: float) -> None:
        """Makes a speed (rad/s at the wheel) the target, limited to what the object holds."""
        self.raw = self._held(speed * self._velocity)
        self.speed_ref = speed

    def _held(self, number: float) -> int:
        """Returns the nearest number that the target's object can hold."""
        low, high = self._limits
        raw = round(number)
        return raw if low <= raw <= high else low if raw < low else high

    def rest(self) -> None:
        """Makes standstill the target."""
        self.ask(0.0)

    def turned(self) -> float:
        """Returns the wheel's turn (rad) since the last complete set, across the wrap of 32 bits."""
        position: int = self.values[POSITION]
        before = position if self.position is None else self.position
        self.position = position
        return ((position - before + 0x80000000 & 0xFFFFFFFF) - 0x80000000) * self.radians_per_count

    def rate(self) -> float:
        """Returns the wheel's measured speed (rad/s)."""
        return float(self.values[VELOCITY] / self._actual)

    def signals(self) -> DriveSignals:
        """Returns the drive as the controller sees it now."""
        values = self.values
        return DriveSignals(self.speed_ref, values[VELOCITY] / self._actual, values[CURRENT] * self._amperes)
