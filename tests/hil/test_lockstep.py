"""Lockstep on vcan0: the run is the one on the wire, and candump has seen what can.log says."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.hil.processes import ON_VCAN, firmware, on_the_bus
from tests.hil.scenarios import short, verdict
from tests.hil.witness import Candump
from tests.program.hilbed import hilbed

LEFT, RIGHT = 1, 2
SERVICES = (0x080, 0x180, 0x280, 0x380, 0x580, 0x700)  # of a drive: EMCY, TPDOs, SDO answers, heartbeat
SENDERS = {f"{base + node:03X}": node for node in (LEFT, RIGHT) for base in SERVICES}


@pytest.fixture(scope="module")
def on_the_wire(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same on the simulated wire alone; nothing is recorded but its hashes."""
    return run(tmp_path_factory.mktemp("wire"), "--record", "none")


def run(folder: Path, *options: str) -> Path:
    """Runs the scenario; returns the run folder."""
    ended = hilbed("run", short(folder), "--out", folder / "run", *options)
    assert ended.status == 0, ended.err
    return folder / "run"


def logged(run: Path) -> list[str]:
    """Returns the frames of can.log in their order, as ID#DATA."""
    return [line.split()[2] for line in (run / "can.log").read_text().splitlines()]


def by_sender(frames: list[str]) -> dict[int, list[str]]:
    """Returns what each drive (its number) and the controller (0) have sent, in their orders."""
    sent: dict[int, list[str]] = {0: [], LEFT: [], RIGHT: []}
    for frame in frames:
        identifier, _, _ = frame.partition("#")
        if len(identifier) == 3:  # not the pins of a drive
            sent[SENDERS.get(identifier, 0)].append(frame)
    return sent


def test_candump_has_seen_what_the_log_says(on_the_wire: Path, candump: Candump, tmp_path: Path) -> None:
    carried = run(tmp_path, *ON_VCAN)
    frames = logged(carried)
    assert len(frames) > 300
    assert [seen.frame for seen in candump.seen()] == frames
    assert verdict(carried)["hash"] == verdict(on_the_wire)["hash"]


def test_firmware_in_processes_gives_the_same_signals(
    on_the_wire: Path, candump: Candump, tmp_path: Path
) -> None:
    nodes = ("--set", "nodes.left=ecu", "--set", "nodes.right=ecu")
    with on_the_bus(firmware(LEFT), firmware(RIGHT)):
        apart = run(tmp_path, *ON_VCAN, *nodes)
    assert verdict(apart)["signals_hash"] == verdict(on_the_wire)["signals_hash"]
    # Who shares vcan0 comes when its process does, but its own frames are in order.
    assert by_sender([seen.frame for seen in candump.seen()]) == by_sender(logged(apart))
