"""Drives on the bus that the scenario does not know: where real motors turn, nobody else's may."""

from __future__ import annotations

from collections.abc import Sequence

from hilbed.can.cob import CONTROLLER_ID
from hilbed.can.link import Link
from hilbed.can.nmt import HeartbeatConsumer
from hilbed.can.node import Node
from hilbed.can.sdo import SdoClient
from hilbed.types import BusError

PROFILE = 402
"""In the low word of 1000: a drive (CiA 402)."""


def refuse(link: Link, heard: HeartbeatConsumer, nodes: Sequence[Node]) -> None:
    """Raises BusError if a drive has been heard that is none of `nodes`, one of which is real.

    Other devices, a battery perhaps, may be on the bus, and those that do not answer.
    """
    if all(node.kind != "real" for node in nodes):
        return
    for number in sorted({*heard.states} - {node.id for node in nodes} - {CONTROLLER_ID}):
        try:
            device = SdoClient(link, "unknown", number).read(0x1000, 0, "u32")
        except BusError:
            continue
        if device & 0xFFFF == PROFILE:
            raise BusError(
                f"node {number} is a drive (1000 is {device:#010x}) that is not in the scenario: a run that "
                "turns real motors does not start with others on the bus"
            )
