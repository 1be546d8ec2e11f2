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
from firmware_sim import Drive, Frame, axis, entry
from firmware_sim.abort import Abort
from firmware_sim.cia402 import TRANSITIONS, Command, State
from firmware_sim.motor_model import MotorModel
from firmware_sim.sdo import SdoServer
from tests.firmware.fuzz import fuzz
from tests.firmware.invariants import EDGES
from tests.firmware.noise import Noise
from tests.firmware.wire import MILLISECOND, NODE, enabled


@pytest.mark.sources
@pytest.mark.parametrize("seed", range(4))
def test_a_hundred_thousand_frames(seed: int) -> None:
    watched, ticks = fuzz(25_000, seed)
    assert len(watched.edges) > 0.7 * len(EDGES)  # the drive was not merely asleep
    assert all(ticks[state] for state in State if state is not State.NOT_READY)
    assert set(watched.modes) == {0, 1, 3, 6, 8, 9}
    assert set(watched.sent) == {"heartbeat", "SDO", "EMCY", "PDO"}


def unlimited(_: MotorModel, speed: float, voltage: float) -> tuple[float, float]:  # noqa: ARG001
    return -1.0, 1.0


@pytest.mark.parametrize(
    ("where", "name", "hole"),
    [
        (MotorModel, "window", unlimited),
        (axis, "TRANSITIONS", {**TRANSITIONS, (State.FAULT, Command.ENABLE): State.ENABLED}),
        (axis, "approach", lambda value, target, rise, fall: 2 * target),  # noqa: ARG005
        (SdoServer, "request", lambda server, t, data: server),  # noqa: ARG005
        (entry.Entry, "check", lambda entry, value: None),  # noqa: ARG005
    ],
    ids=["no current limit", "out of a fault", "beyond the target", "no bytes", "no ranges"],
)
def test_it_finds_a_drive_with_a_hole(
    where: object, name: str, hole: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(where, name, hole)
    with pytest.raises((AssertionError, TypeError, ValueError, KeyError, Abort)):
        fuzz(25_000, seed=1)


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
        noise, drive = Noise(seed), Drive(NODE)
        seen: list[object] = []
        for k in range(3000):
            drive.on_frame(k * MILLISECOND, noise.frame())
            seen.append(drive.tick(k * MILLISECOND, *noise.pins()))
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
    noise = Noise(seed)
    filters: list[Collection[int]] = []
    filtered, plain = Drive(NODE, filters.append), Drive(NODE)
    for t in range(300):
        duties = [drive.tick(t * MILLISECOND, 0, 0, 96) for drive in (filtered, plain)]
        assert duties[0] == duties[1]
        frame = noise.frame()
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
