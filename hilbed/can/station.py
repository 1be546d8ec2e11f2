"""One node as the controller commands it: the axes in it and the RPDOs that carry their orders."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from hilbed.can.axis import Axis
from hilbed.can.cia402 import ENABLE_OPERATION, QUICK_STOP
from hilbed.can.codec import PdoCodec
from hilbed.can.objects import MappedValue
from hilbed.can.sdo import download_frame
from hilbed.types import Frame

_Rpdo = tuple[int, Callable[..., bytes], tuple[Axis | None, ...]]
"""Identifier, how to pack, and for each value whose target it is (None: the controlword)."""


class Station:
    """Axes of one node, most often one; controlword: what it is told to do."""

    __slots__ = ("_rpdos", "axes", "controlword")

    def __init__(self, axes: Sequence[Axis]) -> None:
        self.axes = tuple(axes)
        self.controlword = ENABLE_OPERATION
        node = axes[0].node
        by_number = {axis.node.axis: axis for axis in axes}
        self._rpdos: list[_Rpdo] = []
        for name in node.table.receives:
            values = node.table.values(name)
            codec = PdoCodec([(_name(value, by_number), value.type) for value in values])
            whose = [None if v.word == "controlword" else by_number.get(v.axis or 1) for v in values]
            known = [axis for axis, v in zip(whose, values, strict=True) if _name(v, by_number)]
            self._rpdos.append((node.table.pdos[name].cob_id + node.id, codec.pack, tuple(known)))

    def orders(self) -> Iterator[Frame]:
        """Yields the RPDOs with the controlword and what the axes were asked for."""
        word = self.controlword
        for identifier, pack, whose in self._rpdos:
            yield Frame(identifier, pack(*[word if axis is None else axis.raw for axis in whose]))

    def stop(self) -> Iterator[Frame]:
        """Yields the orders for a quick stop: by SDO, which acts on arrival, and by PDO, now and for good."""
        self.controlword = QUICK_STOP
        node = self.axes[0].node
        entry = node.table.objects["controlword"].of(node.axis)
        yield download_frame(node.id, entry.index, entry.sub, QUICK_STOP.to_bytes(2, "little"))
        for axis in self.axes:
            axis.rest()
        yield from self.orders()


def _name(value: MappedValue, axes: dict[int, Axis]) -> str:
    """Returns a name for what is filled in; the target of an axis that no robot uses stays zero."""
    return value.word if value.word == "controlword" or (value.axis or 1) in axes else ""
