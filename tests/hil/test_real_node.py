"""A run with one real drive: `hilbed drive` is the drive on the desk, the other wheel is simulated."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.hil.processes import ON_VCAN, REALTIME, drive, on_the_bus
from tests.hil.scenarios import short, verdict
from tests.program.hilbed import hilbed

pytestmark = pytest.mark.hil

LEFT = 1
LIMIT, RADIUS = 0.1, 0.1  # m/s, m
ARMED = (*REALTIME, "--arm", "--record", "signals", "--set", "nodes.left=real", "--set", "duration=2")


def test_the_simulated_wheel_follows_a_real_drive_and_a_twin_is_refused(tmp_path: Path) -> None:
    scenario = short(tmp_path)
    with on_the_bus(drive(LEFT)):
        ended = hilbed("run", scenario, *ON_VCAN, *ARMED, "--out", tmp_path / "real")
        assert ended.status == 0, ended
        twin = hilbed("run", scenario, *ON_VCAN, *REALTIME, "--out", tmp_path / "twin")
    signals = np.load(tmp_path / "real" / "signals.npz")
    left = signals["drive/left/speed"]
    print(f"left {left[-1]:.3f} rad/s, limit {LIMIT / RADIUS:.3f} rad/s")
    assert left[-1] == pytest.approx(signals["drive/left/speed_measured"][-1], rel=0.05)
    assert twin.status == 7
    reason = verdict(tmp_path / "twin")["reason"]
    assert "left" in reason
    assert "number 1" in reason or "one number" in reason
    assert "Traceback" not in twin.err
