"""One drive on the bus as the controller knows it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from hilbed.can.drive_table import DriveTable
from hilbed.can.objects import Entry

Kind: TypeAlias = Literal["simulated", "ecu", "real"]
"""Where a drive is: all of it here; its firmware elsewhere; all of it elsewhere."""


HERE = 37
"""The homing method that moves nothing."""


@dataclass(frozen=True)
class Node:
    """A drive by name and node number, its type's table, and what the scenario sets.

    settings: words and numbers by their key in the table's `settings`; mode: key of the table's `modes`;
    axis: which one of the node's, from 1; kind: where it is; max_speed: rad/s of the wheel that the drive is
    told at boot never to exceed, None for its own.
    """

    name: str
    id: int
    table: DriveTable
    mode: str = "csv"
    settings: Mapping[str, float | str] = field(default_factory=dict)
    axis: int = 1
    kind: Kind = "simulated"
    max_speed: float | None = None

    @property
    def first_mode(self) -> str:
        """The mode in which it is enabled: one that must be homed does not move before."""
        return "homing" if self.table.homes else self.mode

    @property
    def searches(self) -> bool:
        """Whether it moves to find its home: by a switch, not where it stands."""
        return self.settings.get("homing", HERE) != HERE

    @property
    def counts_per_turn(self) -> float:
        """Encoder counts a turn of the shaft that carries it."""
        return float(self.settings.get("counts_per_turn", self.table.units.counts_per_turn))

    @property
    def counts_per_radian(self) -> float:
        """Units of 6064 a radian of the wheel, negative where the drive is mounted mirrored."""
        return self.table.units.position_scale(self.counts_per_turn, self.axis)

    @property
    def velocity_per_radian(self) -> float:
        """Units of 60FF a rad/s of the wheel, negative where the drive is mounted mirrored."""
        return self.table.units.velocity_scale(self.counts_per_turn, self.axis)

    @property
    def actual_per_radian(self) -> float:
        """Units of 606C a rad/s of the wheel, negative where the drive is mounted mirrored."""
        return self.table.units.actual_scale(self.counts_per_turn, self.axis)

    @property
    def amperes(self) -> float:
        """A a number in the object of the current, negative where the drive is mounted mirrored."""
        return self.table.units.amperes(self.axis)

    def of(self, word: str) -> Entry:
        """Returns the entry that holds an object of this axis."""
        return self.table.objects[word].of(self.axis)

    def part(self, word: str, value: int) -> int:
        """Returns what of a value that was read from `of(word)` is this axis's."""
        return self.table.objects[word].part(self.axis, value)

    def __str__(self) -> str:
        axis = f", axis {self.axis}" if self.table.axes > 1 else ""
        return f"drive {self.name} (node {self.id}{axis})"


def by_number(nodes: Iterable[Node]) -> dict[int, list[Node]]:
    """Returns drives by the number of their node, in the order given: several axes may be in one node."""
    found: dict[int, list[Node]] = {}
    for node in nodes:
        found.setdefault(node.id, []).append(node)
    return found
