"""Whatever comes over the bus or in at the pins: nothing is raised, nothing leaves its limits."""

from __future__ import annotations

import ast
import random
import sys
from collections.abc import Collection, Iterator
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import firmware_sim
from firmware_sim import Drive, Frame
from tests.firmware.wire import MILLISECOND, NODE, enabled

SERVICES = [0x000, 0x080, 0x200 + NODE, 0x300 + NODE, 0x600 + NODE, 0x700 + NODE, 0x77F, 0x180 + NODE]
INDICES = [0x1003, 0x1005, 0x1014, 0x1016, 0x1017, 0x1400, 0x1600, 0x1800, 0x1A00, 0x1A02]
INDICES += [
    0x2000,
    0x2001,
    0x2002,
    0x2010,
    0x2011,
    0x2012,
    0x2013,
    0x605A,
    0x605E,
    0x6040,
    0x6060,
    0x607F,
    0x60FF,
]


def anything(source: random.Random) -> Frame:
    """Returns a frame that is sometimes nonsense and sometimes nearly right."""
    kind = source.random()
    if kind < 0.3:
        return Frame(
            source.randrange(1 << 29),
            source.randbytes(source.randrange(65)),
            source.random() < 0.5,
            source.random() < 0.2,
        )
    if kind < 0.6:
        return Frame(source.choice(SERVICES), source.randbytes(source.choice((0, 1, 2, 6, 8))))
    if kind < 0.7:
        return Frame(0x000, bytes((source.choice((1, 1, 1, 2, 128, 129, 130)), NODE)))
    if kind < 0.8:
        word = source.choice((0x06, 0x07, 0x0F, 0x0F, 0x02, 0x00, 0x80, 0x10F))
        return Frame(0x200 + NODE, word.to_bytes(2, "little") + source.randbytes(4))
    if kind < 0.9:
        return Frame(0x080)
    head = source.choice((0x23, 0x27, 0x2B, 0x2F, 0x40, 0x21, 0x20, 0x60, 0x70, 0x00, 0x01))
    index, sub = source.choice(INDICES), source.randrange(13)
    return Frame(
        0x600 + NODE, bytes((head,)) + index.to_bytes(2, "little") + bytes((sub,)) + source.randbytes(4)
    )


@pytest.mark.parametrize("seed", range(4))
def test_a_hundred_thousand_frames(seed: int) -> None:
    source = random.Random(seed)
    drive, t, enabled_ticks = Drive(NODE), 0, 0
    for _ in range(25_000):
        drive.on_frame(t, anything(source))
        if source.random() < 0.3:
            duty = drive.tick(
                t, source.randrange(-(2**31), 2**31), source.randrange(-9000, 9000), source.randrange(30, 256)
            )
            assert -32767 <= duty <= 32767
            assert drive.bridge_enabled or duty == 0
            most = drive._axis.settings.max_speed
            assert -most <= drive.speed_ref <= most
            enabled_ticks += drive.bridge_enabled
            t += MILLISECOND
        assert all(0 <= f.id <= 0x7FF and len(f.data) <= 8 and not f.extended for f in drive.outbox)
        drive.outbox.clear()
    assert enabled_ticks > 0  # the drive was not merely asleep


@given(
    st.lists(
        st.tuples(st.integers(0, 0x7FF), st.binary(max_size=64), st.booleans(), st.booleans()), max_size=30
    )
)
@settings(max_examples=50, deadline=None)
def test_an_enabled_drive_stands_any_frame(frames: list[tuple[int, bytes, bool, bool]]) -> None:
    wire = enabled()
    for frame in frames:
        wire.drive.on_frame(wire.t, Frame(*frame))
        wire.run(1)


def test_the_current_stays_in_its_limit_by_the_drives_own_model() -> None:
    source = random.Random(1)
    wire = enabled()
    for _ in range(3000):
        wire.command(0x0F, source.randrange(-200_000, 200_000))
        wire.supply = source.randrange(60, 255)
        wire.run(1, counts_per_tick=source.randrange(-100, 100))
        speed = wire.drive._axis.meter.speed
        volts = wire.supply / 4
        current = (wire.duty / 32767 * volts - 0.9636 * speed) / 0.583
        assert abs(current) <= 10.0 + volts / 32767 / 0.583  # a bit of the duty


def test_the_same_frames_and_ticks_give_the_same_bytes() -> None:
    def trace(seed: int) -> list[object]:
        source, drive = random.Random(seed), Drive(NODE)
        seen: list[object] = []
        for k in range(3000):
            drive.on_frame(k * MILLISECOND, anything(source))
            seen.append(drive.tick(k * MILLISECOND, source.randrange(10**6), 0, 96))
            seen += drive.outbox
            drive.outbox.clear()
        return seen

    assert trace(7) == trace(7)


def imported(path: Path) -> Iterator[str]:
    """Yields what a file imports."""
    for statement in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(statement, ast.Import):
            yield from (alias.name for alias in statement.names)
        elif isinstance(statement, ast.ImportFrom):
            assert statement.level == 0
            yield statement.module or ""


def test_the_firmware_imports_nothing_but_the_standard_library() -> None:
    """Its process, which has to open a bus, also python-can; nothing but its entry point imports that."""
    folder = Path(firmware_sim.__file__).parent
    for path in folder.rglob("*.py"):
        for name in imported(path):
            top, is_process = name.split(".")[0], path == folder / "process.py"
            known = top == "firmware_sim" or top in sys.stdlib_module_names or (top == "can" and is_process)
            assert known, (path, name)
            assert name != "firmware_sim.process" or path == folder / "__main__.py", path


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32))
def test_the_filter_that_it_asks_for_drops_nothing_that_it_would_heed(seed: int) -> None:
    source = random.Random(seed)
    filters: list[Collection[int]] = []
    filtered, plain = Drive(NODE, filters.append), Drive(NODE)
    for t in range(300):
        duties = [drive.tick(t * MILLISECOND, 0, 0, 96) for drive in (filtered, plain)]
        assert duties[0] == duties[1]
        frame = anything(source)
        plain.on_frame(t * MILLISECOND, frame)
        if frame.id in filters[-1] and not frame.extended:
            filtered.on_frame(t * MILLISECOND, frame)
        assert filtered.outbox == plain.outbox
        assert filtered.malformed == plain.malformed
        for drive in (filtered, plain):
            drive.outbox.clear()


def test_the_filter_follows_state_and_identifiers() -> None:
    filters: list[Collection[int]] = []
    drive = Drive(NODE, filters.append)
    drive.tick(0, 0, 0, 96)
    requests, tpdo, rpdo = 0x600 + NODE, 0x180 + NODE, 0x200 + NODE
    assert filters[-1] == {0x000, requests}
    drive.on_frame(0, Frame(0x000, bytes((1, NODE))))
    assert {0x000, 0x080, requests, rpdo} <= set(filters[-1])
    assert tpdo not in filters[-1]
    for off in (1 << 31, 0):  # bit 30 cleared: the PDO may be asked for by a remote frame
        cob = (off | tpdo).to_bytes(4, "little")
        drive.on_frame(0, Frame(requests, b"\x23\x00\x18\x01" + cob))
    assert tpdo in filters[-1]
    drive.on_frame(0, Frame(0x000, bytes((2, NODE))))
    assert filters[-1] == {0x000}
