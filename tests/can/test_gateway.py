"""The gateway between the wire and another bus: who hears what, and what a loss does."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed.can.drive_table import load_table
from hilbed.can.gateway import Gateway
from hilbed.can.node import Node
from hilbed.can.wire import Wire
from hilbed.clock import MILLISECOND
from hilbed.types import BusError, Frame, Nanos, Transfer
from tests.can.far_bus import FarBus

TABLE = load_table("hilbed402")
LEFT, RIGHT = Node("left", 1, TABLE), Node("right", 2, TABLE)
ANSWER, FOREIGN = Frame(0x182, b"12345678"), Frame(0x321, b"x")


class Bench:
    """A wire with a controller and a drive `left` of this process, `right` on the other bus."""

    def __init__(self, lockstep: bool = True) -> None:
        self.transfers: list[Transfer] = []
        self.wire = Wire(500_000, self.transfers.append)
        self.wire.advance(0)
        self.far = FarBus()
        self.controller = self.wire.attach("controller")
        self.left = self.wire.attach("left")
        self.gateway = Gateway(self.wire, self.far, self.wire, lockstep)
        self.gateway.here(LEFT)
        self.gateway.elsewhere(RIGHT)

    def carried(self) -> list[tuple[str, Frame]]:
        return [(transfer.node, transfer.frame) for transfer in self.transfers]


@given(st.lists(st.tuples(st.booleans(), st.integers(0, 0x7FF), st.binary(max_size=8)), max_size=20))
def test_all_that_completes_on_the_wire_goes_out_in_that_order(
    frames: list[tuple[bool, int, bytes]],
) -> None:
    bench = Bench()
    for mine, identifier, data in frames:
        if identifier & 0x7F != RIGHT.id:
            (bench.controller if mine else bench.left).send(0, Frame(identifier, data))
    for k in range(1, 20):
        bench.gateway.advance(k * MILLISECOND)
    good = [transfer.frame for transfer in bench.transfers if not transfer.error]
    assert bench.far.sent == good


def test_a_frame_goes_out_when_it_has_completed_and_not_before() -> None:
    bench = Bench()
    bench.controller.send(0, Frame(0x80))
    bench.gateway.advance(90_000)  # 47 bits of 2 µs and at most some stuff bits
    assert bench.far.sent == []
    bench.gateway.advance(MILLISECOND)
    assert bench.far.sent == [Frame(0x80)]


@pytest.mark.parametrize("lockstep", [True, False])
def test_what_comes_from_a_node_elsewhere_is_on_the_wire_as_its_own_and_does_not_go_back(
    lockstep: bool,
) -> None:
    bench = Bench(lockstep)
    bench.far.incoming.append(ANSWER)
    bench.gateway.pull(5 * MILLISECOND)
    bench.gateway.advance(6 * MILLISECOND)
    (transfer,) = bench.transfers
    assert (transfer.node, transfer.queued, transfer.frame) == ("right", 5 * MILLISECOND, ANSWER)
    assert [received.frame for received in bench.controller.recv(6 * MILLISECOND)] == [ANSWER]
    assert bench.far.sent == []


def test_in_lockstep_strangers_are_counted_and_go_no_further() -> None:
    bench = Bench()
    bench.far.incoming += [FOREIGN, Frame(1, extended=True)]
    bench.gateway.advance(MILLISECOND)
    bench.gateway.advance(2 * MILLISECOND)
    assert (bench.carried(), bench.gateway.foreign) == ([], 2)


def test_in_real_time_strangers_are_heard_here() -> None:
    bench = Bench(lockstep=False)
    request = Frame(0x601, b"\x40\0\x10\0\0\0\0\0")
    bench.far.incoming += [FOREIGN, request]
    bench.gateway.advance(MILLISECOND)
    bench.gateway.advance(2 * MILLISECOND)
    assert bench.carried() == [("gateway", FOREIGN), ("gateway", request)]
    assert [received.frame for received in bench.left.recv(2 * MILLISECOND)] == [FOREIGN, request]
    assert (bench.far.sent, bench.gateway.foreign) == ([], 2)


@pytest.mark.parametrize(
    ("frame", "who"),
    [
        (Frame(0x181, b""), "drive left (node 1) is simulated here"),
        (Frame(0x701, b"\0"), "drive left (node 1) is simulated here"),
        (Frame(0x581, bytes(8)), "drive left (node 1) is simulated here"),
        (Frame(0x081, bytes(8)), "drive left (node 1) is simulated here"),
        (Frame(0x080), "the controller is simulated here"),
        (Frame(0x77F, b"\5"), "the controller is simulated here"),
    ],
)
@pytest.mark.parametrize("lockstep", [True, False])
def test_somebody_else_with_the_number_of_a_node_of_this_process(
    frame: Frame, who: str, lockstep: bool
) -> None:
    bench = Bench(lockstep)
    bench.far.incoming.append(frame)
    with pytest.raises(BusError) as error:
        bench.gateway.advance(2 * MILLISECOND)
    told = f"t = 0.002 s: {who}, but another node on far bus sends {frame.id:03X} as well"
    assert str(error.value).startswith(told)


def test_who_asks_first_gets_the_frame() -> None:
    bench = Bench(lockstep=False)
    taken: list[Frame] = []

    def take(frame: Frame) -> bool:
        taken.append(frame)
        return frame.extended

    bench.gateway.intercept(take)
    pin = Frame(0x1FFE0102, b"pins", extended=True)
    bench.far.incoming += [pin, ANSWER]
    bench.gateway.advance(MILLISECOND)
    bench.gateway.advance(2 * MILLISECOND)
    assert taken == [pin, ANSWER]
    assert bench.carried() == [("right", ANSWER)]


def advance(bench: Bench, t: Nanos) -> None:
    bench.controller.send(t - MILLISECOND, Frame(0x201, bytes(6)))
    bench.gateway.advance(t)


@pytest.mark.parametrize("lockstep", [True, False])
def test_a_lost_bus_ends_the_run_and_then_no_longer_matters(lockstep: bool) -> None:
    """What is to be sent after it is lost is dropped; when it comes back, only what is new goes out."""
    bench = Bench(lockstep)
    bench.far.lost = "Network is down"
    with pytest.raises(BusError, match=r"t = 0\.000 s: far bus: lost while sending: Network is down"):
        advance(bench, MILLISECOND)
    with pytest.raises(BusError, match=r"t = 0\.007 s: far bus: lost while receiving: Network is down"):
        bench.gateway.pull(7 * MILLISECOND)
    bench.gateway.stop()
    assert bench.far.purged == (not lockstep)  # what waits in real time is old, in lockstep it is not
    advance(bench, 8 * MILLISECOND)
    bench.far.lost = ""
    advance(bench, 9 * MILLISECOND)
    assert len(bench.far.sent) == 1
    assert len(bench.transfers) == 3


def test_its_account() -> None:
    bench = Bench()
    bench.far.incoming.append(FOREIGN)
    bench.far.counts.errors = 3
    bench.gateway.pull(0)
    account = bench.gateway.account()
    assert (account["name"], account["foreign"], account["errors"]) == ("far bus", 1, 3)
