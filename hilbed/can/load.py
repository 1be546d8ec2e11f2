"""Worst-case load of the bus by what is sent over and over, known before anything runs."""

from __future__ import annotations

from collections.abc import Sequence

from hilbed.can.frame_length import INTERFRAME_BITS
from hilbed.can.node import Node, by_number


def worst_bits(size: int, extended: bool = False) -> int:
    """Returns the bits of a data frame with `size` bytes if stuffing is as bad as it can be.

    Interframe space included: 47 + 8n + ⌊(34 + 8n − 1)/4⌋ for a standard identifier (the stuffed part has
    34 + 8n bits, a first stuff bit follows five of them and then one each four), 20 more bits for an
    extended one.
    """
    stuffed = (54 if extended else 34) + 8 * size
    return stuffed + 10 + INTERFRAME_BITS + (stuffed - 1) // 4


def periodic_load(nodes: Sequence[Node], period: float, bitrate: int) -> float:
    """Returns the share of the bus (1 = 100 %) that the periodic traffic takes at worst.

    period: s, of SYNC. Counted: SYNC, RPDO1 to every drive, its TPDOs, heartbeats of all.
    """
    bits = worst_bits(0) / period
    if nodes:
        bits += worst_bits(1) * 1e3 / min(node.table.heartbeat.controller for node in nodes)
    return (bits + sum(_node_bits(axes[0], period) for axes in by_number(nodes).values())) / bitrate


def _node_bits(node: Node, period: float) -> float:
    """Returns bits/s of what is sent to and by a drive."""
    table = node.table
    bits = worst_bits(1) * 1e3 / table.heartbeat.drive
    bits += sum(worst_bits(table.codec(name).size) for name in table.receives) / period
    for name, pdo in table.pdos.items():
        if name[0] == "t":
            synchronous = pdo.transmission <= 240
            seconds = period * max(1, pdo.transmission) if synchronous else pdo.event_timer / 1e3
            bits += worst_bits(table.codec(name).size) / seconds if seconds else 0.0
    return bits
