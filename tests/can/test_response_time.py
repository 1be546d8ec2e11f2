"""Response times on the wire against the analysis of Davis, Burns, Bril and Lukkien (2007).

Controller Area Network (CAN) schedulability analysis: refuted, revisited and revised; Real-Time Systems 35.
Their bound is taken with the frames' actual lengths instead of the worst stuffing.
"""

from __future__ import annotations

import random
from typing import NamedTuple

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hilbed.can.arbitration import arbitration
from hilbed.can.frame_length import INTERFRAME_BITS
from hilbed.can.frame_length import frame_bits as bits
from hilbed.can.wire import Wire
from hilbed.types import Frame, Nanos, Transfer

BIT: Nanos = 2_000  # 500 kbit/s
SPACE = INTERFRAME_BITS * BIT


class Message(NamedTuple):
    """A frame that its own node sends every `period` ns, the first time at `offset`."""

    frame: Frame
    period: Nanos
    offset: Nanos

    @property
    def length(self) -> Nanos:
        """C in the paper: the time on the bus, interframe space included."""
        return bits(self.frame) * BIT + SPACE


def bound(messages: list[Message], m: int, grain: Nanos = BIT, begun: Nanos = 0) -> Nanos:
    """Returns the worst response time of messages[m], which are in the order of their priority.

    Equations 4 to 9 without queueing jitter: the busy period t, then each instance q in it. From queueing to
    the last bit, so without the interframe space behind. grain: of time, a bit in the paper; begun: for how
    long a frame of lower priority has been on the bus already, the paper has nothing off.
    """
    higher, this, lower = messages[:m], messages[m], messages[m + 1 :]
    blocking = max((one.length - begun for one in lower), default=0)
    busy = this.length
    while True:
        longer = blocking + sum(-(-busy // one.period) * one.length for one in [*higher, this])
        if longer == busy:
            break
        busy = longer
    worst = 0
    for q in range(-(-busy // this.period)):
        wait = blocking + q * this.length
        while True:
            longer = blocking + q * this.length
            longer += sum(-(-(wait + grain) // one.period) * one.length for one in higher)
            if longer == wait:
                break
            wait = longer
        worst = max(worst, wait - q * this.period + this.length)
    return worst - SPACE


def responses(messages: list[Message], duration: Nanos) -> dict[Frame, Nanos]:
    """Returns the longest time from queueing to the last bit of each message, every one sent by a node."""
    longest = dict.fromkeys((one.frame for one in messages), 0)

    def see(transfer: Transfer) -> None:
        longest[transfer.frame] = max(longest[transfer.frame], transfer.end - transfer.queued)

    wire = Wire(500_000, see)
    wire.attach("listener")
    for k, message in enumerate(messages):
        port = wire.attach(str(k))
        for t in range(message.offset, duration, message.period):
            port.send(t, message.frame)
    wire.advance(2 * duration)
    return longest


@st.composite
def sets_of_messages(draw: st.DrawFn) -> list[Message]:
    """Messages of at most 95 % load, highest priority first, with whatever offsets."""
    identifiers = draw(st.lists(st.integers(0, 0x7FF), min_size=2, max_size=9, unique=True))
    load, messages = 0.0, []
    for identifier in identifiers:
        extended = draw(st.booleans())
        frame = Frame(identifier << 18 if extended else identifier, draw(st.binary(max_size=8)), extended)
        period = draw(st.integers(300, 6_000)) * 1_000
        message = Message(frame, period, draw(st.integers(0, period)))
        if load + message.length / period < 0.95:
            load += message.length / period
            messages.append(message)
    return sorted(messages, key=lambda one: arbitration(one.frame.id, one.frame.extended, one.frame.remote))


@settings(deadline=None, max_examples=150)
@given(sets_of_messages())
def test_no_response_is_longer_than_the_bound(messages: list[Message]) -> None:
    longest = responses(messages, 60_000_000)
    for m, message in enumerate(messages):
        assert longest[message.frame] <= bound(messages, m)


def at_the_critical_instant(messages: list[Message], m: int) -> Nanos:
    """Returns the longest response of messages[m] where all that matter are released in the worst moment.

    That is one nanosecond after the longest frame of lower priority has started.
    """
    blocker = max(messages[m + 1 :], key=lambda one: one.length, default=None)
    together = [one._replace(offset=1) for one in messages[: m + 1]]
    if blocker is not None:
        together.append(blocker._replace(offset=0, period=10**12))
    return responses(together, 60_000_000)[messages[m].frame]


@settings(deadline=None, max_examples=100)
@given(sets_of_messages())
def test_at_the_critical_instant_the_wire_does_what_the_analysis_says_to_the_nanosecond(
    messages: list[Message],
) -> None:
    for m in range(len(messages)):
        assert at_the_critical_instant(messages, m) == bound(messages, m, grain=1, begun=1)


@pytest.mark.parametrize("seed", range(20))
def test_the_worst_one_meets_the_bound_within_one_frame(seed: int) -> None:
    """The bound is a bit coarser than the wire, which may let one more frame in, or a few in a row."""
    rng = random.Random(seed)
    messages: list[Message] = []
    for identifier in sorted(rng.sample(range(0x800), 8)):
        message = Message(
            Frame(identifier, rng.randbytes(rng.randint(0, 8))), rng.randint(400, 6_000) * 1_000, 0
        )
        if sum(one.length / one.period for one in [*messages, message]) < 0.95:
            messages.append(message)
    found = [(at_the_critical_instant(messages, m), bound(messages, m)) for m in range(len(messages))]
    longest, limit = max(found)
    assert limit - max(one.length for one in messages) <= longest <= limit


def test_the_example_of_the_paper() -> None:
    """Section 3.3: three messages of equal length at 98 % load; the third one's second instance is the worst.

    Periods 2.5, 3.5 and 3.5 lengths: the analysis of 1994 said 3 lengths for the last, the truth is 3.5.
    """
    alike = [frame for frame in (Frame(k, bytes(8)) for k in range(0x800)) if bits(frame) == 122]
    unit = (122 + INTERFRAME_BITS) * BIT  # 125 bits, as there
    periods = (5 * unit // 2, 7 * unit // 2, 7 * unit // 2)
    messages = [Message(frame, period, 0) for frame, period in zip(alike[:3], periods, strict=True)]
    assert bound(messages, 2) + SPACE == 7 * unit // 2
    longest = responses(messages, 200_000_000)
    assert longest[messages[2].frame] + SPACE == 7 * unit // 2


@settings(deadline=None, max_examples=60)
@given(
    st.lists(
        st.tuples(st.integers(0, 2), st.integers(0, 0x7FF), st.binary(max_size=8)), min_size=50, max_size=300
    )
)
def test_a_saturated_bus_delivers_everything_in_order_of_priority(sent: list[tuple[int, int, bytes]]) -> None:
    seen: list[Transfer] = []
    wire = Wire(500_000, seen.append)
    ports = [wire.attach(name) for name in "abc"]
    listener = wire.attach("listener")
    frames = [(who, Frame(identifier & ~3 | who, data)) for who, identifier, data in sent]
    for who, frame in frames:
        ports[who].send(0, frame)
    wire.advance(10**9)
    heard = [received.frame for received in listener.recv(10**9)]
    assert heard == sorted((frame for _, frame in frames), key=lambda frame: frame.id), "equal ones as queued"
    starts, ends = [one.start for one in seen], [one.end for one in seen]
    assert starts == [0, *(end + SPACE for end in ends[:-1])], "and the bus is never idle"
