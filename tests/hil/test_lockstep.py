"""Lockstep on vcan0: the run is the one on the wire, and candump has seen what can.log says."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.hil.processes import ON_VCAN, firmware, on_the_bus
from tests.hil.scenarios import short, verdict
from tests.hil.witness import Candump
from tests.program.hilbed import hilbed

pytestmark = pytest.mark.hil

LEFT, RIGHT = 1, 2
OF_DRIVES = tuple(
    f"{base + node:03X}" for node in (LEFT, RIGHT) for base in (0x180, 0x280, 0x380, 0x580, 0x700)
)


@pytest.fixture(scope="module")
def on_the_wire(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return run(tmp_path_factory.mktemp("wire"))


def run(folder: Path, *options: str) -> Path:
    """Runs the scenario with `record: all`; returns the run folder."""
    ended = hilbed("run", short(folder), "--out", folder / "run", *options)
    assert ended.status == 0, ended.err
    return folder / "run"


def logged(run: Path) -> list[str]:
    """Returns the frames of can.log in their order, as ID#DATA."""
    return [line.split()[2] for line in (run / "can.log").read_text().splitlines()]


def sent_by_drives(frames: list[str], theirs: bool) -> list[str]:
    return [frame for frame in frames if (frame.partition("#")[0] in OF_DRIVES) == theirs]


def test_candump_has_seen_what_the_log_says(on_the_wire: Path, candump: Candump, tmp_path: Path) -> None:
    carried = run(tmp_path, *ON_VCAN)
    frames = logged(carried)
    assert len(frames) > 300
    assert [seen.frame for seen in candump.seen()] == frames == logged(on_the_wire)
    assert verdict(carried)["hash"] == verdict(on_the_wire)["hash"]


def test_firmware_in_processes_gives_the_same_signals(
    on_the_wire: Path, candump: Candump, tmp_path: Path
) -> None:
    nodes = ("--set", "nodes.left=ecu", "--set", "nodes.right=ecu")
    with on_the_bus(firmware(LEFT), firmware(RIGHT)):
        apart = run(tmp_path, *ON_VCAN, *nodes)
    assert verdict(apart)["signals_hash"] == verdict(on_the_wire)["signals_hash"]
    # Drives and controller share vcan0 as they like; each one's frames are in its own order.
    seen = [seen.frame for seen in candump.seen() if len(seen.frame.partition("#")[0]) == 3]
    for theirs in (True, False):
        assert sent_by_drives(seen, theirs) == sent_by_drives(logged(apart), theirs)
