"""A drive that holds an angle: the steering axis."""

from __future__ import annotations

from math import nan

from hilbed.can.axis import CURRENT, POSITION, VELOCITY, Axis
from hilbed.can.node import Node
from hilbed.types import DriveSignals


class PositionAxis(Axis):
    """An axis whose target is an angle (rad); what a robot wants to know of it is the angle itself."""

    __slots__ = ("_per_radian", "angle_ref")

    def __init__(self, node: Node) -> None:
        super().__init__(node)
        self.speed_ref = nan
        self.angle_ref = 0.0
        self._per_radian = node.counts_per_radian

    def ask(self, angle: float) -> None:
        """Makes an angle (rad) the target, limited to what the object holds."""
        self.raw = self._held(angle * self._per_radian)
        self.angle_ref = angle

    def rest(self) -> None:
        """Leaves the target where it is."""

    def turned(self) -> float:
        """Returns the angle (rad) half-way from the last complete set to this one."""
        position: int = self.values[POSITION]
        before = position if self.position is None else self.position
        self.position = position
        return 0.5 * (before + position) * self.radians_per_count

    def rate(self) -> float:
        """Returns the measured angle (rad): what stands in for a rate where a robot's speeds are asked."""
        return float(self.values[POSITION] * self.radians_per_count)

    def signals(self) -> DriveSignals:
        values = self.values
        return DriveSignals(
            nan, values[VELOCITY] / self._actual, values[CURRENT] * self._amperes, self.angle_ref, self.rate()
        )


def axis_of(node: Node) -> Axis:
    """Returns the axis of a drive: what its table commands decides which one."""
    return (PositionAxis if node.table.positions else Axis)(node)
