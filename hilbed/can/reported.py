"""What a real drive says of itself: its PDOs, and the targets that it was sent, in SI units at the wheel."""

from __future__ import annotations

import struct
from collections.abc import Callable, Collection
from math import nan
from typing import Protocol

from hilbed.can.node import Node
from hilbed.can.position_axis import axis_of
from hilbed.types import Frame, Nanos


class Port(Protocol):
    """A place on the wire that hears what it asks for."""

    def accept(self, identifiers: Collection[int]) -> None: ...


class Reported:
    """Listens on the wire to one drive; polarity, gear and units are those of its table.

    speed, speed_ref: rad/s at the wheel; angle: rad, of a drive that is told a position, which tells no
    speed_ref; current: A in the wheel's direction; NaN before anything was heard.
    """

    def __init__(self, node: Node, attach: Callable[[str, Callable[[Nanos, Frame], None]], Port]) -> None:
        self.speed = self.current = self.speed_ref = self.angle = nan
        self._axis = axis_of(node)
        self._routes = self._axis.routes()
        self._target = node.table.pdos["rpdo1"].cob_id + node.id
        codec = node.table.codec("rpdo1")
        self._unpack, self._place = codec.unpack, codec.names.index(node.table.target)
        self._scale = nan if node.table.positions else node.velocity_per_radian
        attach(f"{node.name} as reported", self._hear).accept({*self._routes, self._target})

    def _hear(self, _: Nanos, frame: Frame) -> None:
        if frame.extended or frame.remote:
            return
        try:
            if frame.id == self._target:
                self.speed_ref = self._unpack(frame.data)[self._place] / self._scale
            else:
                self._take(frame)
        except struct.error:
            return  # shorter than its mapping: the controller counts it

    def _take(self, frame: Frame) -> None:
        axis, unpack, slots, _ = self._routes[frame.id]
        for slot, value in zip(slots, unpack(frame.data), strict=True):
            axis.values[slot] = value
        signals = axis.signals()
        self.speed, self.current = signals.speed_measured, signals.current_measured
        self.angle = signals.angle_measured
