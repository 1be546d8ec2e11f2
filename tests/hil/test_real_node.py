"""A run with one real drive: `hilbed drive` is the drive on the desk, the other wheel is simulated."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.hil.processes import ON_VCAN, REALTIME, drive, on_the_bus
from tests.hil.scenarios import short, verdict
from tests.program.hilbed import hilbed

LEFT = 1
LIMIT, RADIUS = 0.1, 0.1  # m/s, m
TOO_LATE = 0.2  # s; the drive stops at a heartbeat that is 0.25 s late
PACED = (*ON_VCAN, *REALTIME, "--set", "duration=2")
REAL = ("--arm", "--record", "signals", "--set", "nodes.left=real")


def test_the_simulated_wheel_follows_a_real_drive_and_a_twin_is_refused(tmp_path: Path) -> None:
    scenario = short(tmp_path)
    with on_the_bus(drive(LEFT)):
        ended = hilbed("run", scenario, *PACED, *REAL, "--out", tmp_path / "real")
        assert ended.status == 0, ended
        twin = hilbed("run", scenario, *PACED, "--record", "none", "--out", tmp_path / "twin")
    late = verdict(tmp_path / "real")["realtime"]["lateness"]["worst"]
    if late > TOO_LATE:
        pytest.skip(f"this machine is too busy for real time: a cycle began {late:.2f} s late")
    signals = np.load(tmp_path / "real" / "signals.npz")
    left = signals["drive/left/speed"]
    assert left.max() == pytest.approx(LIMIT / RADIUS, rel=0.1), ended.out
    assert left[-1] == pytest.approx(signals["drive/left/speed_measured"][-1], rel=0.05)
    assert twin.status == 7
    reason = verdict(tmp_path / "twin")["reason"]
    assert "left" in reason
    assert "number 1" in reason or "one number" in reason
    assert "Traceback" not in twin.err
