"""vcan0 goes down in the middle of a run: exit 7 with the reason, no traceback, no hang."""

from __future__ import annotations

import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.hil.drives import Probe
from tests.hil.processes import ON_VCAN, REALTIME, VCAN, running
from tests.hil.scenarios import short, verdict

SYNC = 0x080


def link(state: str) -> None:
    subprocess.run(["ip", "link", "set", VCAN, state], check=True, capture_output=True)


@pytest.fixture
def bus_to_lose() -> Iterator[None]:
    try:
        link("up")
    except (OSError, subprocess.CalledProcessError) as error:
        pytest.skip(f"{VCAN} cannot be switched off and on here: {error}")
    yield
    link("up")


@pytest.mark.usefixtures("bus_to_lose")
@pytest.mark.parametrize("pace", [(), REALTIME], ids=["lockstep", "realtime"])
def test_a_bus_that_goes_down_ends_the_run(pace: tuple[str, ...], tmp_path: Path) -> None:
    probe = Probe()
    out = tmp_path / "run"
    long = ("--record", "none", "--set", "duration=300", "--set", "reference.speed=0.01", "--out", str(out))
    with running("hilbed", "run", str(short(tmp_path)), *ON_VCAN, *pace, *long) as process:
        for _ in range(20):
            probe.await_frame(SYNC, process=process)
        link("down")
        probe.close()
        _, errors = process.communicate(timeout=120)
    assert process.returncode == 7
    told = verdict(out)
    assert not told["passed"]
    assert "vcan0" in told["reason"]
    assert "lost" in told["reason"]
    assert "Traceback" not in errors
