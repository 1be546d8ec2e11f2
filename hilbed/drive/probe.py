"""Looks before a drive comes on the bus whether its node number is taken."""

from __future__ import annotations

from time import monotonic

from hilbed.can.hardware import Adapter
from hilbed.types import BusError, Frame

PATIENCE = 0.1
"""s; a node answers within milliseconds, on a slow machine in a few more."""
_READ_DEVICE_TYPE = b"\x40\x00\x10\x00\0\0\0\0"


def refuse_twin(adapter: Adapter, node: int) -> None:
    """Asks the node for its device type (1000); BusError if somebody with its number says anything."""
    adapter.send(Frame(0x600 + node, _READ_DEVICE_TYPE))
    deadline = monotonic() + PATIENCE
    while (left := deadline - monotonic()) > 0.0:
        for frame in adapter.wait(left):
            if not frame.extended and frame.id in (0x580 + node, 0x700 + node, 0x180 + node):
                raise BusError(
                    f"{adapter.name}: there is a node {node} on the bus already ({frame.id:03X} was heard): "
                    "switch it off or give --node another number"
                )
