"""Who sends which identifier on the bench's own bus."""

from __future__ import annotations

from collections.abc import Iterable

from hilbed.can.cob import CONTROLLER_ID, EMERGENCY, HEARTBEAT, NMT, SDO_ANSWER, SDO_REQUEST, SYNC
from hilbed.can.node import Node

CONTROLLER = "controller"
"""Name of the controller among the nodes on the wire."""


def senders(nodes: Iterable[Node]) -> dict[int, str]:
    """Returns the name of the node that sends each identifier: the controller or one of the drives."""
    known = dict.fromkeys((NMT, SYNC, HEARTBEAT + CONTROLLER_ID), CONTROLLER)
    for node in nodes:
        known[SDO_REQUEST + node.id] = CONTROLLER
        for base in (EMERGENCY, SDO_ANSWER, HEARTBEAT):
            known[base + node.id] = node.name
        for name, pdo in node.table.pdos.items():
            known[pdo.cob_id + node.id] = node.name if name[0] == "t" else CONTROLLER
    return known
