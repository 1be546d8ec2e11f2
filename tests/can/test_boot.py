"""Booting firmware drives over the wire, and everything that a boot can find wrong."""

from __future__ import annotations

from typing import Any

import pytest

from hilbed.can.drive_table import load_table
from hilbed.can.master import Master
from hilbed.can.node import Node
from hilbed.can.specs import NodeSpec
from hilbed.clock import MILLISECOND
from hilbed.types import BusError
from tests.can.rig import PERIOD, TwoDrives


def value(bench: TwoDrives, drive: int, index: int, sub: int) -> Any:
    return bench.shafts[drive].drive._node._values[index << 8 | sub]  # what is really in the firmware


def test_two_drives_are_enabled_before_the_start() -> None:
    bench = TwoDrives()
    assert bench.boot() == 0
    assert bench.wire.now == 0
    assert all(shaft.drive.bridge_enabled for shaft in bench.shafts)
    assert all(shaft.drive.speed_ref == 0 for shaft in bench.shafts)
    assert all(shaft.drive.malformed == 0 for shaft in bench.shafts)


def test_settings_of_the_scenario_reach_the_firmware() -> None:
    spec = NodeSpec(
        id=9,
        loop="relay",
        mode="pv",
        counts_per_turn=16_500,
        current_limit=5.5,
        slew=100.0,
        gains={"kp": 0.25, "relay_layer": 0.5},
    )
    bench = TwoDrives({"right": spec})
    bench.boot()
    expected = [
        (0x2010, 1, 2),
        (0x6061, 0, 3),
        (0x2001, 0, 16_500),
        (0x2013, 1, 5.5),
        (0x2013, 4, 100.0),
        (0x2010, 2, 0.25),
        (0x2011, 2, 0.5),
        (0x1006, 0, 10_000),
        (0x60C2, 1, 10),
        (0x2002, 0, 50),
        (0x1016, 1, 127 << 16 | 250),
        (0x1017, 0, 100),
    ]
    assert [(index, sub, value(bench, 1, index, sub)) for index, sub, _ in expected] == expected
    assert value(bench, 0, 0x2010, 1) == 0
    assert value(bench, 0, 0x6061, 0) == 9


def test_drives_give_a_slow_controller_time() -> None:
    bench = TwoDrives()
    Master(bench.nodes, bench.port, 500 * MILLISECOND).boot(bench.pump, -600 * MILLISECOND)
    assert value(bench, 0, 0x1016, 1) & 0xFFFF == 1500
    assert (value(bench, 0, 0x60C2, 1), value(bench, 0, 0x60C2, 2)) == (50, -2)


def test_a_missing_drive() -> None:
    bench = TwoDrives(powered=1)
    with pytest.raises(BusError, match=r"drive right \(node 2\): no boot-up message 702"):
        bench.boot()


def retabled(bench: TwoDrives, **update: Any) -> Master:
    table = load_table("hilbed402").model_copy(update=update)
    return Master([Node("left", 1, table)], bench.port, PERIOD)


def test_a_drive_of_another_type() -> None:
    bench = TwoDrives()
    identity = load_table("hilbed402").identity.model_copy(update={"product": 0x99})
    with pytest.raises(
        BusError, match=r"drive left \(node 1\) is no hilbed402: 1018:02 is 0x402, expected 0x99"
    ):
        retabled(bench, identity=identity).boot(bench.pump, -600 * MILLISECOND)


def test_a_value_that_the_drive_refuses() -> None:
    bench = TwoDrives()
    write = load_table("hilbed402").writes[0].model_copy(update={"index": 0x1000})
    with pytest.raises(BusError, match=r"left \(node 1\).*1000:00.*can only be read"):
        retabled(bench, writes=[write]).boot(bench.pump, -600 * MILLISECOND)


def test_a_setting_out_of_the_drives_range() -> None:
    bench = TwoDrives({"left": NodeSpec(current_limit=1000.0)})
    with pytest.raises(BusError, match=r"left \(node 1\).*2013:01.*0609003"):
        bench.boot()


def test_a_boot_that_does_not_end_in_time() -> None:
    bench = TwoDrives()
    with pytest.raises(BusError, match="not ready by t = 0 s"):
        bench.boot(-20 * MILLISECOND)


def test_a_drive_that_cannot_be_enabled_says_why() -> None:
    bench = TwoDrives()
    bench.shafts[0].supply = 4
    with pytest.raises(BusError, match=r"left \(node 1\): in fault .*0x3220: DC link undervoltage"):
        bench.boot()


def test_boot_is_the_same_every_time() -> None:
    first, second = TwoDrives(), TwoDrives()
    first.boot()
    second.boot()
    assert first.transfers == second.transfers


def test_a_second_boot_finds_drives_in_operation() -> None:
    bench = TwoDrives()
    bench.boot(-2000 * MILLISECOND)
    Master(bench.nodes, bench.port, PERIOD).boot(bench.pump, 0, ready=600 * MILLISECOND)
    assert all(shaft.drive.bridge_enabled for shaft in bench.shafts)
