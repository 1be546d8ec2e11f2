"""What every Bus does: each frame once to everybody else, in the order of the wire, not before its time."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hilbed.types import BusError, Frame, Received
from tests.contract.buses import MEDIA

NODES = 3
LONG = 10**9

data = st.binary(max_size=8)
no, yes = st.just(False), st.just(True)
standard = st.builds(Frame, st.integers(0, 0x7FF), data, no, no)
extended = st.builds(Frame, st.integers(0, 0x1FFF_FFFF), data, yes, no)
remote = st.builds(Frame, st.integers(0, 0x7FF), st.integers(0, 8).map(bytes), no, yes)
frames = st.one_of(standard, extended, remote)


def own(who: int, frame: Frame) -> Frame:
    """Returns the frame with an identifier of that node's own: two nodes with one collide."""
    return frame._replace(id=frame.id & ~3 | who)


sendings = st.lists(
    st.tuples(st.integers(0, 400_000), st.integers(0, NODES - 1), frames).map(
        lambda sending: (*sending[:2], own(*sending[1:]))
    ),
    max_size=12,
)


@pytest.mark.parametrize("kind", MEDIA)
@settings(max_examples=60, deadline=None)
@given(sendings)
def test_each_frame_comes_once_to_every_other_node(kind: str, sent: list[tuple[int, int, Frame]]) -> None:
    with MEDIA[kind](NODES) as (nodes, advance):
        now = 0
        heard: list[list[Received]] = [[] for _ in nodes]
        for wait, sender, frame in sent:
            nodes[sender].send(now, frame)
            now += wait
            advance(now)
            for node, received in zip(nodes, heard, strict=True):
                fresh = node.recv(now)
                assert all(r.t <= now for r in fresh)
                received += fresh
        advance(now + LONG)
        for node, received in zip(nodes, heard, strict=True):
            received += node.recv(now + LONG)
            assert node.recv(now + LONG) == []
    for k, received in enumerate(heard):
        assert sorted(r.frame for r in received) == sorted(frame for _, who, frame in sent if who != k)
        assert [r.t for r in received] == sorted({r.t for r in received}), "one at a time, oldest first"
    for a, b in ((0, 1), (1, 2)):
        common = {r.t for r in heard[a]} & {r.t for r in heard[b]}
        assert [r for r in heard[a] if r.t in common] == [r for r in heard[b] if r.t in common]


@pytest.mark.parametrize("kind", MEDIA)
@given(
    st.sets(st.integers(0, 0x7FF), min_size=2, max_size=10).flatmap(lambda ids: st.permutations(sorted(ids)))
)
def test_of_what_waits_the_lowest_identifier_goes_first(kind: str, identifiers: list[int]) -> None:
    with MEDIA[kind](2) as (nodes, advance):
        for identifier in identifiers:
            nodes[0].send(0, Frame(identifier))
        advance(LONG)
        assert [r.frame.id for r in nodes[1].recv(LONG)] == sorted(identifiers)


@pytest.mark.parametrize("kind", MEDIA)
def test_a_frame_takes_its_time(kind: str) -> None:
    """500 kbit/s: a frame of 8 bytes lasts 111 to 135 bits of 2 µs without the space that follows."""
    with MEDIA[kind](2) as (nodes, advance):
        nodes[0].send(0, Frame(0x123, b"12345678"))
        advance(108 * 2000)
        assert nodes[1].recv(108 * 2000) == []
        advance(132 * 2000)
        (received,) = nodes[1].recv(132 * 2000)
        assert 108 * 2000 < received.t <= 132 * 2000
        assert received.frame == Frame(0x123, b"12345678")


@pytest.mark.parametrize("kind", MEDIA)
@pytest.mark.parametrize(
    "frame",
    [Frame(0x800), Frame(-1), Frame(0x2000_0000, extended=True), Frame(1, bytes(9))],
    ids=["too high", "negative", "too high extended", "too long"],
)
def test_what_is_no_can_frame_is_refused_and_not_sent(kind: str, frame: Frame) -> None:
    with MEDIA[kind](2) as (nodes, advance):
        with pytest.raises(BusError):
            nodes[0].send(0, frame)
        advance(LONG)
        assert nodes[1].recv(LONG) == []
