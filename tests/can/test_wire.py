"""The wire against a brute-force simulator that looks at every nanosecond-exact moment of decision."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hilbed.can.arbitration import arbitration
from hilbed.can.frame_length import frame_bits
from hilbed.can.port import Port
from hilbed.can.statistics import Statistics, load
from hilbed.can.wire import Wire
from hilbed.types import BusError, Frame, Nanos, Transfer

BIT = 2000  # ns at 500 kbit/s
Job = tuple[Nanos, int, Frame]


def arbitration_bits(frame: Frame) -> str:
    """The levels from identifier to RTR as they appear on the bus, 1 recessive, padded with what follows."""
    if frame.extended:
        identifier = format(frame.id, "029b")
        return identifier[:11] + "11" + identifier[11:] + ("1" if frame.remote else "0")
    return format(frame.id, "011b") + ("1" if frame.remote else "0") + "0"


def brute_force(jobs: list[Job]) -> list[tuple[Nanos, Nanos, Frame]]:
    """Serves jobs one after another: of those queued when the bus is free, the lowest bits go first."""
    left = sorted(enumerate(jobs), key=lambda job: job[1][0])
    free, served = 0, []
    while left:
        start = max(free, left[0][1][0])
        rivals = [job for job in left if job[1][0] <= start]
        winner = min(rivals, key=lambda job: (arbitration_bits(job[1][2]).ljust(40, "0"), job[0]))
        left.remove(winner)
        frame = winner[1][2]
        end = start + frame_bits(frame) * BIT
        served.append((start, end, frame))
        free = end + 3 * BIT
    return served


frames = st.builds(
    lambda ident, low, data, extended, remote: Frame(
        ident << 18 | low if extended else ident, data, extended, remote
    ),
    st.sampled_from([0, 1, 0x80, 0x181, 0x7FF]),
    st.sampled_from([0, 1, 0x3FFFF]),
    st.binary(max_size=8),
    st.booleans(),
    st.booleans(),
)


def own(who: int, frame: Frame) -> Frame:
    """Returns the frame with an identifier that no other node sends: two nodes with one is an error."""
    low = (frame.id & 3 | 4 * who) if frame.extended else (frame.id & 0x7F0 | who << 2 | frame.id & 3)
    return frame._replace(id=frame.id & ~0x3FFFF | low if frame.extended else low)


jobs_of_three = st.lists(
    st.tuples(st.integers(0, 2_000_000), st.integers(0, 2), frames).map(lambda j: (j[0], j[1], own(*j[1:]))),
    max_size=30,
)


@settings(deadline=None)
@given(jobs_of_three, st.lists(st.integers(0, 12_000_000), max_size=8))
def test_same_as_brute_force_however_time_is_cut(jobs: list[Job], stops: list[Nanos]) -> None:
    seen: list[Transfer] = []
    wire = Wire(500_000, seen.append)
    ports = [wire.attach(name) for name in "abc"]
    for t, who, frame in jobs:
        ports[who].send(t, frame)
    for stop in sorted(stops):
        wire.advance(stop)
    wire.advance(60_000_000)
    assert [(s.start, s.end, s.frame) for s in seen] == brute_force(jobs)
    assert all(transfer.start >= transfer.queued for transfer in seen)


@settings(deadline=None)
@given(jobs_of_three)
def test_sending_when_the_moment_comes_is_the_same_as_ahead(jobs: list[Job]) -> None:
    seen: list[Transfer] = []
    wire = Wire(500_000, seen.append)
    ports = [wire.attach(name) for name in "abc"]
    in_time = sorted(jobs, key=lambda job: job[0])
    for t, who, frame in in_time:
        wire.advance(t)
        ports[who].send(t, frame)
    wire.advance(60_000_000)
    assert [(s.start, s.end, s.frame) for s in seen] == brute_force(in_time)


@settings(deadline=None)
@given(jobs_of_three)
def test_everyone_but_the_sender_hears_every_frame_once(jobs: list[Job]) -> None:
    wire = Wire(500_000)
    ports = [wire.attach(name) for name in "abc"]
    for t, who, frame in jobs:
        ports[who].send(t, frame)
    wire.advance(60_000_000)
    for number, port in enumerate(ports):
        heard = [received.frame for received in port.recv(60_000_000)]
        assert sorted(heard) == sorted(frame for _, who, frame in jobs if who != number)
        assert port.recv(60_000_000) == []


@given(frames, frames)
def test_arbitration_number_orders_as_the_bits_do(one: Frame, other: Frame) -> None:
    bits = [arbitration_bits(frame).ljust(40, "0") for frame in (one, other)]
    keys = [arbitration(frame.id, frame.extended, frame.remote) for frame in (one, other)]
    assert (bits[0] < bits[1]) == (keys[0] < keys[1])


def test_data_beats_remote_and_standard_beats_extended() -> None:
    seen: list[Transfer] = []
    wire = Wire(500_000, seen.append)
    port = wire.attach("a")
    wire.attach("b")
    order = [Frame(5), Frame(5, remote=True), Frame(5 << 18, extended=True), Frame(6)]
    for frame in reversed(order):
        port.send(0, frame)
    wire.advance(10_000_000)
    assert [transfer.frame for transfer in seen] == order


def test_a_frame_on_the_bus_is_not_interrupted_and_latency_is_counted() -> None:
    seen: list[Transfer] = []
    wire = Wire(500_000, seen.append)
    a, b = wire.attach("a"), wire.attach("b")
    low, high = Frame(0x700, bytes(8)), Frame(0x001)
    a.send(0, low)
    b.send(1000, high)
    wire.advance(10_000_000)
    end = frame_bits(low) * BIT
    assert [(s.node, s.queued, s.start) for s in seen] == [("a", 0, 0), ("b", 1000, end + 3 * BIT)]
    assert wire.statistics().worst_latency == end + 3 * BIT - 1000


def test_a_node_may_answer_at_the_moment_of_reception() -> None:
    wire = Wire(500_000)
    ports: list[Port] = []
    ports.append(wire.attach("echo", lambda t, frame: ports[0].send(t, Frame(frame.id + 1, frame.data))))
    master = wire.attach("master")
    master.send(0, Frame(0x100, b"hi"))
    wire.advance(5_000_000)
    (answer,) = master.recv(5_000_000)
    first, second = frame_bits(Frame(0x100, b"hi")), frame_bits(Frame(0x101, b"hi"))
    assert answer == ((first + 3 + second) * BIT, Frame(0x101, b"hi"))


def test_recv_gives_only_what_has_arrived_by_then() -> None:
    wire = Wire(500_000)
    a, b = wire.attach("a"), wire.attach("b")
    a.send(0, Frame(1))
    a.send(3_000_000, Frame(2))
    wire.advance(5_000_000)
    assert [received.frame.id for received in b.recv(1_000_000)] == [1]
    assert [received.frame.id for received in b.recv(5_000_000)] == [2]


def test_nothing_is_delivered_before_its_last_bit() -> None:
    wire = Wire(500_000)
    a, b = wire.attach("a"), wire.attach("b")
    a.send(0, Frame(1))
    end = frame_bits(Frame(1)) * BIT
    wire.advance(end - 1)
    assert b.recv(end) == []
    assert wire.pending == 1
    wire.advance(end)
    assert [received.t for received in b.recv(end)] == [end]
    assert wire.pending == 0


def test_negative_times() -> None:
    wire = Wire(500_000)
    a, b = wire.attach("a"), wire.attach("b")
    a.send(-1_000_000, Frame(1))
    wire.advance(-500_000)
    assert [received.t for received in b.recv(-500_000)] == [-1_000_000 + frame_bits(Frame(1)) * BIT]


def test_load_is_the_share_of_bits_with_interframe_space() -> None:
    wire = Wire(500_000)
    a = wire.attach("a")
    wire.attach("b")
    wire.advance(0)
    before = wire.statistics()
    for cycle in range(10):
        a.send(cycle * 10_000_000, Frame(0x80))
    wire.advance(100_000_000)
    after = wire.statistics()
    assert after.frames == 10
    assert load(before, after) == pytest.approx((frame_bits(Frame(0x80)) + 3) / 5000)
    assert load(after, after) == 0.0


@settings(deadline=None)
@given(jobs_of_three, st.frozensets(st.sampled_from([0, 1, 8, 0x80, 0x189, 0x7FB])))
def test_a_filter_lets_its_identifiers_and_extended_frames_through(
    jobs: list[Job], accepted: frozenset[int]
) -> None:
    wire = Wire(500_000)
    ports = [wire.attach(name) for name in "abc"]
    ports[1].accept(accepted)
    for t, who, frame in jobs:
        ports[who].send(t, frame)
    wire.advance(60_000_000)
    heard = [received.frame for received in ports[1].recv(60_000_000)]
    others = [frame for _, who, frame in jobs if who != 1]
    assert sorted(heard) == sorted(f for f in others if f.extended or f.id in accepted)
    assert len(ports[0].recv(60_000_000)) == sum(who != 0 for _, who, _ in jobs)


def test_a_filter_can_change_between_frames() -> None:
    wire = Wire(500_000)
    a, b = wire.attach("a"), wire.attach("b")
    for accepted in ({1}, {2}, None):
        b.accept(accepted)
        a.send(wire.now, Frame(1))
        wire.advance(wire.now + 1_000_000)
    assert len(b.recv(wire.now)) == 2


def test_a_node_that_left_hears_nothing_but_its_frames_still_go() -> None:
    wire = Wire(500_000)
    a, b = wire.attach("a"), wire.attach("b")
    a.send(0, Frame(1))
    b.send(0, Frame(2))
    wire.detach(a)
    wire.advance(5_000_000)
    assert a.recv(5_000_000) == []
    assert [received.frame.id for received in b.recv(5_000_000)] == [1]


@pytest.mark.parametrize("bitrate", [0, -1, 300_000])
def test_impossible_bit_rates(bitrate: int) -> None:
    with pytest.raises(BusError, match="bit rate"):
        Wire(bitrate)


def test_statistics_start_at_nothing() -> None:
    wire = Wire(125_000)
    wire.advance(0)
    assert wire.statistics() == Statistics(0, 0, 0, 0)
