"""A firmware behind terminal frames does what the same firmware does when it is called."""

from __future__ import annotations

import random

from hypothesis import given
from hypothesis import strategies as st

from firmware_sim.drive import Drive
from firmware_sim.frame import Frame
from firmware_sim.terminal import TO_FIRMWARE, Terminal, micro
from hilbed.can import terminal as bench
from hilbed.plant import pins
from hilbed.types import Frame as BenchFrame
from tests.firmware.noise import Noise

NODE = 5
MS = 1_000_000
MOST = 2_147_000_000  # µrad/s: beyond it the answer clips


def seen(frame: Frame) -> BenchFrame:
    return BenchFrame(*frame)


def tick(terminal: Terminal, counts: int, current: int, supply: int, counter: int) -> bench.Answer | None:
    """Shows pins; returns what comes last, which has to be the answer to them."""
    sent = terminal.receive(bench.pins(NODE, counts, current, supply, counter))
    if not sent:
        return None
    assert bench.answering(seen(sent[-1])) == NODE
    return bench.answer(sent[-1].data)


@given(st.integers(0, 2**32), st.integers(-(2**31), 2**31 - 1))
def test_frames_or_calls_make_no_difference(seed: int, start: int) -> None:
    source, noise = random.Random(seed), Noise(seed)
    terminal, filtered = Terminal(NODE), {0: frozenset[int]()}
    drive = Drive(NODE, lambda wanted: filtered.update({0: frozenset(wanted)}))
    for k in range(60):
        arrived = [noise.frame() for _ in range(source.randrange(4))] if k else []
        heard = [frame for frame in arrived if frame.id in filtered[0]]
        for frame in arrived:
            assert terminal.receive(frame) == []
        for frame in heard:
            drive.on_frame(k * MS, frame)
        counts = (start + 40 * k + 2**31) % 2**32 - 2**31
        duty = drive.tick(k * MS, counts, source.randrange(-99, 99), 96)
        sent = terminal.receive(bench.pins(NODE, counts, drive._axis.current, 96, k & 0xFF))
        assert sent[:-1] == drive.outbox
        answer = bench.answer(sent[-1].data)
        assert answer is not None
        assert answer[:4] == (duty, drive.bridge_enabled, drive.faulted, k & 0xFF)
        assert answer.speed_ref == max(-MOST, min(MOST, round(1e6 * drive.speed_ref)))
        drive.outbox.clear()


@given(st.lists(st.tuples(st.sampled_from([TO_FIRMWARE + NODE, TO_FIRMWARE + NODE + 1, 0, 0x605]),
                          st.binary(max_size=8), st.booleans(), st.booleans()), max_size=30))  # fmt: skip
def test_no_frame_raises(frames: list[tuple[int, bytes, bool, bool]]) -> None:
    terminal = Terminal(NODE)
    for frame in frames:
        for sent in terminal.receive(Frame(*frame)):
            assert len(sent.data) <= 8


def test_a_repeated_or_old_frame_makes_no_tick() -> None:
    terminal = Terminal(NODE)
    assert tick(terminal, 0, 0, 96, 7) is not None
    for counter in (7, 6, 0, 7 - 128 & 0xFF):
        assert tick(terminal, 0, 0, 96, counter) is None
    assert terminal.repeated == 4
    assert tick(terminal, 0, 0, 96, 8) is not None


def test_time_goes_on_over_lost_frames() -> None:
    """The heartbeat that was due meanwhile is sent with the next tick."""
    terminal = Terminal(NODE)
    tick(terminal, 0, 0, 96, 250)
    for index, value in ((0x1017, 50),):
        request = bytes((0x2B,)) + index.to_bytes(2, "little") + b"\0" + value.to_bytes(4, "little")
        terminal.receive(Frame(0x600 + NODE, request))
    tick(terminal, 0, 0, 96, 251)  # heartbeats from here on
    tick(terminal, 0, 0, 96, 252)
    early = terminal.receive(bench.pins(NODE, 0, 0, 96, 252 + 48 & 0xFF))
    assert 0x700 + NODE not in [frame.id for frame in early]
    late = terminal.receive(bench.pins(NODE, 0, 0, 96, 252 + 51 & 0xFF))
    assert 0x700 + NODE in [frame.id for frame in late]
    assert terminal.lost == 47 + 2


def test_power_starts_it_anew() -> None:
    terminal = Terminal(NODE)
    first = terminal.receive(bench.pins(NODE, 0, 0, 96, 0))
    assert first[0] == Frame(0x700 + NODE, b"\0")  # boot-up
    assert len(terminal.receive(bench.pins(NODE, 0, 0, 96, 1))) == 1
    (acknowledged,) = terminal.receive(bench.power(NODE))
    assert bench.answering(seen(acknowledged)) == NODE
    assert acknowledged.data == b""
    assert terminal.receive(bench.pins(NODE, 0, 0, 96, 0)) == first


def test_digital_inputs_are_read_and_not_answered() -> None:
    terminal = Terminal(NODE)
    tick(terminal, 0, 0, 96, 0)
    assert terminal.receive(Frame(*bench.inputs(NODE, 4))) == []
    terminal.receive(Frame(0x600 + NODE, bytes((0x40, 0xFD, 0x60, 0, 0, 0, 0, 0))))
    answer = next(f for f in terminal.receive(bench.pins(NODE, 0, 0, 96, 1)) if f.id == 0x580 + NODE)
    assert answer.data[4] == 4
    assert terminal.malformed == 0


def test_without_ticks_its_memory_is_bounded() -> None:
    terminal = Terminal(NODE)
    tick(terminal, 0, 0, 96, 0)
    for _ in range(5000):
        terminal.receive(Frame(0x000, b"\x80\x7f"))
    assert terminal.overrun == 5000 - 4096
    assert tick(terminal, 0, 0, 96, 1) is not None


@given(st.floats(-1e6, 1e6) | st.just(float("inf")))
def test_microradians_fit_and_clip(speed: float) -> None:
    assert -(2**31) <= micro(speed) < 2**31
    if abs(speed) < 2000:
        assert abs(pins.speed(micro(speed)) - speed) <= 0.5001e-6
    else:
        assert micro(speed) * speed > 0
        assert abs(micro(speed)) >= 2_000_000_000
