"""A scan finds who is there and what they are, and leaves everything as it was."""

from __future__ import annotations

import json
from argparse import ArgumentParser, Namespace

import can
import canopen
import pytest

from firmware_sim import eds
from hilbed.bustools.options import add_tools, bus
from hilbed.bustools.scan import Found, scan, table_of
from hilbed.can.link import Pump
from hilbed.clock import MILLISECOND
from hilbed.types import Command, Frame
from tests.can.rig import TwoDrives

LISTEN = 150 * MILLISECOND


def _options(*arguments: str) -> Namespace:
    parser = ArgumentParser()
    add_tools(parser)
    return parser.parse_args(arguments)


def _driven(bench: TwoDrives) -> Pump:
    """Lets time pass while the controller goes on with its cycles."""

    def pump(t: int) -> int:
        if t % (10 * MILLISECOND) == 0:
            bench.base.read(t)
            bench.base.write(t, Command(0.3, 0.1))
        return bench.pump(t)

    return pump


def test_drives_before_boot() -> None:
    bench = TwoDrives()
    found = scan(bench.port, bench.pump, LISTEN)
    assert [node.node for node in found] == [1, 2]
    first = found[0]
    assert (first.device_type, first.vendor, first.product, first.revision) == (0x20192, 0, 0x402, 0x10000)
    assert first.name == "hilbed simulated drive"
    assert first.table == "hilbed402"
    assert first.power == "switch on disabled"
    assert first.trouble == ""


def test_running_drives_are_not_disturbed() -> None:
    bench = TwoDrives()
    t = bench.boot()
    for _ in range(20):
        bench.cycle(t, Command(0.3, 0.1))
        t += 10 * MILLISECOND
    before = len(bench.transfers)

    found = scan(bench.stranger, _driven(bench), LISTEN, t)
    assert [(node.node, node.state, node.power, node.error) for node in found] == [
        (1, "operational", "operation enabled", None),
        (2, "operational", "operation enabled", None),
        (127, "operational", None, None),  # the controller, which has no objects
    ]
    said = [transfer.frame for transfer in bench.transfers[before:] if transfer.node == "stranger"]
    assert {frame.id for frame in said} == {0x600 + node for node in range(1, 128)}
    uploads = {0x40, 0x60, 0x70}  # initiate, segments with either toggle
    assert {frame.data[0] for frame in said} == uploads
    assert bench.base.faulted == ()
    assert bench.base.silences == 0
    left, right = (shaft.speed for shaft in bench.shafts)
    assert (left, right) == (pytest.approx(2.8, rel=0.05), pytest.approx(3.2, rel=0.05))


def test_a_fault_is_shown() -> None:
    bench = TwoDrives()
    t = bench.boot()
    bench.shafts[0].supply = 30  # 7.5 V
    found = scan(bench.stranger, _driven(bench), LISTEN, t)
    assert (found[0].power, found[0].error) == ("fault", 0x3220)
    assert "DC link undervoltage" in table_of(found)


def test_two_nodes_with_one_number_are_told() -> None:
    bench = TwoDrives()

    def answer(t: int, frame: Frame) -> None:
        """Answers like node 2, later than it."""
        if frame.id == 0x602 and frame.data[1:4] == b"\x00\x10\x00":
            twin.send(t + 3 * MILLISECOND, Frame(0x582, b"\x43\x00\x10\x00\x92\x01\x02\x00"))

    twin = bench.wire.attach("twin", answer)
    found = scan(bench.port, bench.pump, LISTEN)
    assert found[1].trouble == "2 nodes answer to this number"


def test_a_node_that_only_says_that_it_lives() -> None:
    bench = TwoDrives(powered=0)
    bench.stranger.send(50 * MILLISECOND, Frame(0x70A, b"\x04"))
    assert scan(bench.port, bench.pump, LISTEN) == [Found(10, state="stopped", trouble="answers no SDO")]


def test_an_empty_bus() -> None:
    bench = TwoDrives(powered=0)
    assert scan(bench.port, bench.pump, LISTEN) == []
    assert table_of([]).startswith("no node found")


@pytest.mark.parametrize("as_json", [True, False])
def test_the_command_finds_an_independent_node(as_json: bool, capsys: pytest.CaptureFixture[str]) -> None:
    """canopen's LocalNode answers from a thread of its own."""
    network = canopen.Network()
    network.connect(interface="virtual", channel="scan")
    try:
        node = canopen.LocalNode(5, str(eds.PATH))
        network.add_node(node)
        node.sdo[0x6041].raw = 0x0637
        arguments = ["scan", "-i", "virtual", "-c", "scan", "--listen", "0.01"]
        assert bus(_options(*arguments, *(["--json"] if as_json else []))) == 0
    finally:
        network.disconnect()
    out = capsys.readouterr().out
    if as_json:
        (found,) = json.loads(out)
        assert (found["node"], found["device_type"], found["product"]) == (5, 0x20192, 0x402)
        assert found["power"] == "operation enabled"
        assert "state" not in found
    else:
        assert out.split()[:2] == ["node", "5"]
        assert "table hilbed402" in out


def test_what_a_virtual_bus_carries_is_what_was_asked() -> None:
    """An independent listener sees questions and nothing else."""
    with can.Bus(interface="virtual", channel="asked") as listener:
        assert bus(_options("scan", "-i", "virtual", "-c", "asked", "--listen", "0")) == 0
        heard = list(iter(lambda: listener.recv(0), None))
    assert [message.arbitration_id for message in heard] == [0x600 + node for node in range(1, 128)]
    assert {bytes(message.data) for message in heard} == {bytes((0x40, 0, 0x10, 0, 0, 0, 0, 0))}
