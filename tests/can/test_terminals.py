"""Pins and answers on the bench's side, over a carrier and a clock that the test moves."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from firmware_sim.terminal import Terminal as Firmware
from hilbed.can import terminal
from hilbed.can.drive_table import load_table
from hilbed.can.node import Node
from hilbed.can.terminals import PATIENCE, REPEAT, Terminals
from hilbed.types import BusError, Frame, Interrupted, Nanos

LEFT = Node("left", 1, load_table("hilbed402"), kind="ecu")
RIGHT = Node("right", 2, load_table("hilbed402"), kind="ecu")


def go_on() -> None:
    """Never tells that it is over."""


class Far:
    """Firmware on the other side: hears what is sent, and what it answers comes with the next pull.

    deaf: node numbers that no longer answer; delay: pulls that an answer takes.
    """

    def __init__(self, *nodes: Node, lockstep: bool = True, delay: int = 0) -> None:
        self.firmware = {node.id: Firmware(node.id) for node in nodes}
        self.deaf: set[int] = set()
        self.delay = delay
        self.time = 0.0
        self.coming: list[tuple[int, Frame]] = []
        self.terminals = Terminals(nodes, self.send, self.pull, lambda: self.time, lockstep)
        self.change: Callable[[Frame], list[Frame]] = lambda frame: [frame]

    def send(self, frame: Frame) -> None:
        for number, firmware in self.firmware.items():
            answers = [Frame(*sent) for sent in firmware.receive(frame)]
            if number not in self.deaf:
                self.coming += [(self.delay, sent) for one in answers for sent in self.change(one)]

    def pull(self, _: Nanos, timeout: float) -> None:
        self.time += min(timeout, 0.01) if self.coming else timeout
        waiting, self.coming = self.coming, []
        for left, frame in waiting:
            if left:
                self.coming.append((left - 1, frame))
            elif terminal.is_terminal(frame):
                assert self.terminals.take(frame)

    def tick(self, t: Nanos = 0, counts: int = 0) -> None:
        for one in self.terminals.by_node.values():
            one.present(counts, 0, 96)
        self.terminals.collect(t)


def test_in_lockstep_every_tick_has_its_answer() -> None:
    far = Far(LEFT, RIGHT, delay=3)
    far.terminals.power(0, go_on)
    for k in range(600):  # the counter wraps
        far.tick(counts=k)
        assert {one.answer.counter for one in far.terminals.by_node.values()} == {k & 0xFF}
    assert {one.late for one in far.terminals.by_node.values()} == {0}


def test_firmware_that_is_not_there_is_named() -> None:
    far = Far(LEFT, RIGHT)
    far.deaf.add(2)
    with pytest.raises(BusError, match=r"^drive right \(node 2\): its firmware does not come up .* --node 2"):
        far.terminals.power(0, go_on)
    assert far.time == pytest.approx(PATIENCE)


def test_switching_on_ends_where_it_is_told_to() -> None:
    far, asked = Far(LEFT), iter([None, None, Interrupted("SIGTERM")])
    far.deaf.add(LEFT.id)

    def going() -> None:
        verdict = next(asked)
        if verdict is not None:
            raise verdict

    with pytest.raises(Interrupted):
        far.terminals.power(0, going)
    assert far.time == pytest.approx(2 * REPEAT)


def test_firmware_that_starts_late_is_switched_on_again() -> None:
    far = Far(LEFT)
    far.deaf.add(1)
    pull, calls = far.pull, 0

    def start_late(t: Nanos, timeout: float) -> None:
        nonlocal calls
        calls += 1
        if calls == 3:
            far.deaf.clear()
        pull(t, timeout)

    far.terminals._pull = start_late
    far.terminals.power(0, go_on)
    assert far.time < PATIENCE


def test_firmware_that_falls_silent_is_given_up_once() -> None:
    far = Far(LEFT, RIGHT)
    far.terminals.power(0, go_on)
    far.tick()
    far.deaf.add(1)
    with pytest.raises(BusError, match=r"t = 0.5 s: drive left \(node 1\): no answer"):
        far.tick(500_000_000)
    far.tick()  # the others can still be brought to rest
    left, right = far.terminals.by_node.values()
    assert (left.gone, left.answer.enabled) == (True, False)
    assert right.answered


def test_strangers_that_talk_all_the_time_do_not_keep_a_tick_waiting() -> None:
    far = Far(LEFT)
    far.terminals.power(0, go_on)
    far.deaf.add(1)
    pull = far.pull

    def babble(t: Nanos, timeout: float) -> None:
        far.coming.append((0, Frame(0x001)))
        pull(t, timeout)

    far.terminals._pull = babble
    with pytest.raises(BusError, match="no answer"):
        far.tick()


def test_two_that_answer_are_told() -> None:
    far = Far(LEFT)
    far.terminals.power(0, go_on)
    far.change = lambda frame: [frame, frame]
    with pytest.raises(BusError, match="two processes are its firmware"):
        far.tick()


@pytest.mark.parametrize(
    ("delay", "late", "held"), [(0, 0, 19), (1, 0, 19), (2, 0, 18), (3, 19, 18), (4, 19, 17)]
)
def test_in_real_time_a_late_answer_is_held_and_counted(delay: int, late: int, held: int) -> None:
    """There are two pulls a tick: an answer that the next tick still finds in time is not late."""
    far = Far(LEFT, lockstep=False)
    far.terminals.power(0, go_on)
    far.delay = delay
    for _ in range(20):
        far.tick()
        far.pull(0, 0.0)
    (left,) = far.terminals.by_node.values()
    assert (left.late, left.answer.counter) == (late, held)


@given(st.lists(st.tuples(st.integers(0, 0x1FFFFFFF), st.binary(max_size=8), st.booleans(), st.booleans())))
def test_whatever_comes(frames: list[tuple[int, bytes, bool, bool]]) -> None:
    far = Far(LEFT)
    for number, data, extended, remote in frames:
        for identifier in (number, terminal.FROM_FIRMWARE + 1):
            far.terminals.take(Frame(identifier, data, extended, remote))


def test_an_answer_without_a_speed_is_one() -> None:
    assert terminal.answer(b"\x01\x80\x03\x07") == terminal.Answer(-32767, True, True, 7, 0)
    assert terminal.answer(b"\x01\x80\x03\x07\0") is None
