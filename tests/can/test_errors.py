"""Errors on the wire against a bus that is played bit by bit."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from hilbed.can.error_state import BUS_OFF, PASSIVE
from hilbed.can.frame_layout import beyond_arbitration, layout
from hilbed.can.frame_length import frame_bits
from hilbed.can.wire import Wire
from hilbed.types import ACK_ERROR, BIT_ERROR, NO_ERROR, Frame, Nanos, Transfer
from tests.can import bit_level
from tests.can.bit_level import Node

BIT: Nanos = 2_000
BITS = 8_000

frames = st.builds(
    lambda ident, low, data, extended, remote: Frame(
        ident << 18 | low if extended else ident, data, extended, remote
    ),
    st.integers(0, 0x7FF),
    st.integers(0, 0x3FFFF),
    st.lists(st.sampled_from([0x00, 0xFF, 0x1F, 0xE0]) | st.integers(0, 255), max_size=8).map(bytes),
    st.booleans(),
    st.booleans(),
)


class Scripted:
    """Inverts one bit of each attempt in a list."""

    def __init__(self, places: dict[int, int]) -> None:
        self._places = places
        self._attempt = -1

    def queued(self, t: Nanos, _: Frame, __: str) -> list[Nanos]:
        return [t]

    def disturbed(self, _: Nanos, __: Frame, ___: str) -> int | None:
        self._attempt += 1
        return self._places.get(self._attempt)


def played(
    sent: list[Frame], listeners: int, disturbed: dict[int, int]
) -> tuple[list[Node], list[Transfer], Wire]:
    """Lets nodes a, b, … send one frame each from bit 0 on: bit by bit, and on the wire."""
    nodes = [Node("abcdef"[k], frame) for k, frame in enumerate(sent)]
    nodes += [Node("xyz"[k]) for k in range(listeners)]
    seen: list[Transfer] = []
    wire = Wire(500_000, seen.append)
    wire.tamper(Scripted(disturbed))
    for node in nodes:
        port = wire.attach(node.name)
        port.recovers = False
        if node.frame is not None:
            port.send(0, node.frame)
    bit_level.run(nodes, BITS, disturbed)
    wire.advance(BITS * BIT)
    return nodes, seen, wire


def compare(nodes: list[Node], seen: list[Transfer], wire: Wire) -> None:
    """Asserts that both have seen the same."""
    ends: dict[str, int] = {}
    for transfer in seen:
        if not transfer.error:
            ends |= dict.fromkeys(transfer.node.split("+"), transfer.end // BIT)
    for node in nodes:
        errors = wire.port(node.name).errors
        assert (errors.tec, errors.rec) == (node.tec, node.rec), node.name
        assert ends.get(node.name) == node.done, node.name


@settings(deadline=None, max_examples=200)
@given(frames)
def test_a_layout_is_the_frame_bit_by_bit(frame: Frame) -> None:
    assert layout(frame) == bit_level.bits_of(frame)
    assert len(layout(frame)) == frame_bits(frame)
    assert beyond_arbitration(frame) == bit_level.arbitration_end(frame)


@settings(deadline=None, max_examples=60)
@given(frames, st.lists(st.floats(0, 1), min_size=1, max_size=45), st.integers(1, 3))
def test_disturbed_frames(frame: Frame, places: list[float], listeners: int) -> None:
    """One error frame for each disturbed attempt, of the length that the flags have; then it gets through."""
    first, last = beyond_arbitration(frame), frame_bits(frame) - 11
    disturbed = {k: first + round(place * (last - first)) for k, place in enumerate(places)}
    nodes, seen, wire = played([frame], listeners, disturbed)
    compare(nodes, seen, wire)
    assert all(
        transfer.error == (BIT_ERROR if k < len(places) else NO_ERROR) for k, transfer in enumerate(seen)
    )
    for transfer, place in zip(seen, disturbed.values(), strict=False):
        flags = (transfer.end - transfer.start) // BIT - (place + 1) - 8
        assert 6 <= flags <= 12


@settings(deadline=None, max_examples=60)
@given(frames, st.lists(st.binary(max_size=8), min_size=2, max_size=3))
def test_nodes_with_one_identifier(frame: Frame, contents: list[bytes]) -> None:
    """They destroy each other's frames until they are error passive; then all get through, one by one."""
    sent = [frame._replace(data=bytes(len(data)) if frame.remote else data) for data in contents]
    nodes, seen, wire = played(sent, 1, {})
    compare(nodes, seen, wire)
    through = [transfer.frame for transfer in seen if not transfer.error]
    assert sorted(through) == sorted(set(sent)), "what is alike is one frame"


@settings(deadline=None, max_examples=30)
@given(frames)
def test_a_node_that_is_alone(frame: Frame) -> None:
    nodes, seen, wire = played([frame], 0, {})
    compare(nodes, seen, wire)
    assert {transfer.error for transfer in seen} == {ACK_ERROR}
    assert wire.port("a").errors.state == PASSIVE


def test_bus_off_after_32_errors_and_the_way_back() -> None:
    frame = Frame(0x123, b"data")
    states: list[tuple[Nanos, str, str]] = []
    seen: list[Transfer] = []
    wire = Wire(500_000, seen.append, lambda *state: states.append(state))
    wire.tamper(Scripted(dict.fromkeys(range(32), 40)))
    a = wire.attach("a")
    b = wire.attach("b")
    a.send(0, frame)
    a.send(0, Frame(0x124))
    wire.advance(10**9)
    assert [(name, state) for _, name, state in states if name == "a"] == [
        ("a", "error passive"),
        ("a", "bus-off"),
        ("a", "error active"),
    ]
    assert len(seen) == 32
    off, back = (
        next(t for t, name, state in states if state == wanted) for wanted in (BUS_OFF, "error active")
    )
    assert off == seen[-1].end
    assert back - off == 128 * 11 * BIT - 0 * BIT
    assert a.lost == 1, "what waits when a node leaves the bus is lost"
    assert b.recv(10**9) == []
    a.send(10**9, frame)
    wire.advance(2 * 10**9)
    assert len(b.recv(2 * 10**9)) == 1
