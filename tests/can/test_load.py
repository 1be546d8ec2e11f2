"""Worst-case bus load against the table in the facts (two drives, SYNC + RPDO1 + TPDO1 each)."""

from __future__ import annotations

import pytest

from hilbed.can.drive_table import load_table
from hilbed.can.load import periodic_load, worst_bits
from hilbed.can.node import Node


def nodes() -> list[Node]:
    """Two drives without TPDO2, TPDO3 and (practically) without heartbeats."""
    table = load_table("hilbed402")
    tpdo1 = table.pdos["tpdo1"].model_copy(update={"map": ["statusword", "velocity_actual", "torque_actual"]})
    rare = table.heartbeat.model_copy(update={"drive": 10**9, "controller": 10**9})
    bare = table.model_copy(
        update={"pdos": {"rpdo1": table.pdos["rpdo1"], "tpdo1": tpdo1}, "heartbeat": rare}
    )
    return [Node("left", 1, bare), Node("right", 2, bare)]


@pytest.mark.parametrize(
    ("rate", "bitrate", "percent"),
    [
        (100, 250_000, 22),
        (100, 500_000, 11),
        (100, 1_000_000, 6),
        (500, 250_000, 111),
        (500, 500_000, 56),
        (500, 1_000_000, 28),
        (1000, 250_000, 222),
        (1000, 500_000, 111),
        (1000, 1_000_000, 56),
    ],
)
def test_table_of_the_facts(rate: int, bitrate: int, percent: int) -> None:
    assert round(100 * periodic_load(nodes(), 1 / rate, bitrate)) == percent


def test_eight_bytes_take_135_bits() -> None:
    assert worst_bits(8) == 135


def test_every_pdo_and_heartbeat_counts() -> None:
    table = load_table("hilbed402")
    bits = 100 * (55 + worst_bits(6) + worst_bits(8) + worst_bits(6)) + 10 * (
        worst_bits(7) + 2 * worst_bits(1)
    )
    assert periodic_load([Node("left", 1, table)], 0.01, 500_000) == pytest.approx(bits / 500_000)
