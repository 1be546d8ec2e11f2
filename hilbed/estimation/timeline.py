"""What a filter must remember to take a late reading at its own time."""

from __future__ import annotations

from bisect import bisect_left, insort
from dataclasses import dataclass, field

from hilbed.types import Array, Innovation, Nanos, Reading


@dataclass(slots=True, eq=False)
class Measurement:
    """A reading made ready: when it was exposed, its variance, and what the filter last said of it."""

    t: Nanos
    reading: Reading
    value: float
    variance: float
    innovation: Innovation | None = None


@dataclass(slots=True, eq=False)
class Node:
    """One moment: the way (m) and turn (rad) that led to it, what was measured, what was then believed.

    refused: measurements refused in a row up to here.
    """

    t: Nanos
    mean: Array
    covariance: Array
    distance: float = 0.0
    turn: float = 0.0
    measurements: list[Measurement] = field(default_factory=list)
    refused: int = 0


class Timeline:
    """Nodes in the order of their times; never empty."""

    def __init__(self, start: Node, memory: Nanos) -> None:
        self.nodes = [start]
        self._memory = memory

    @property
    def last(self) -> Node:
        """The newest node."""
        return self.nodes[-1]

    @property
    def oldest(self) -> Nanos:
        """The time after which a measurement can still be inserted."""
        return self.nodes[0].t

    def extend(self, t: Nanos, distance: float, turn: float) -> None:
        """Adds an odometry increment that ends at `t`, later than all before; forgets what is too old."""
        last = self.nodes[-1]
        self.nodes.append(Node(t, last.mean, last.covariance, distance, turn))
        surplus = 0
        while self.nodes[surplus + 1].t < t - self._memory:
            surplus += 1
        del self.nodes[:surplus]

    def insert(self, measurement: Measurement) -> int:
        """Puts a measurement at its time, cutting an increment in two if need be; returns the node's index.

        Within one moment measurements are in an order of their own, so that the order of arrival is nothing.
        The time must be after `oldest` and not after the last node's.
        """
        index = bisect_left(self.nodes, measurement.t, key=lambda node: node.t)
        node = self.nodes[index]
        if node.t != measurement.t:
            node = cut(self.nodes[index - 1], node, measurement.t)
            self.nodes.insert(index, node)
        insort(node.measurements, measurement, key=_order)
        return index


def cut(before: Node, after: Node, t: Nanos) -> Node:
    """Makes the node at `t` between two: it takes its share of the way that leads to `after`."""
    share = (t - before.t) / (after.t - before.t)
    middle = Node(t, before.mean, before.covariance, share * after.distance, share * after.turn)
    after.distance -= middle.distance
    after.turn -= middle.turn
    return middle


def _order(measurement: Measurement) -> tuple[str, int, float]:
    reading = measurement.reading
    return reading.kind, -1 if reading.beacon is None else reading.beacon, measurement.value
