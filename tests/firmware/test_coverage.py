"""Every line and every branch of the state machine, of what it moves, and of the SDO server is tested."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

WHOLE = (
    "axis.py", "cia402.py", "course.py", "cyclic_position.py", "homing.py", "place.py", "positioner.py",
    "profile_position.py", "sdo.py",
)  # fmt: skip
TESTS = (
    "test_cia402.py", "test_homing.py", "test_limits.py", "test_modes.py", "test_nmt.py",
    "test_position.py", "test_profile_position.py", "test_sdo.py",
    "test_state_machine.py::test_the_axis_does_what_the_profile_says",
)  # fmt: skip


@pytest.mark.sources
def test_no_line_and_no_branch_is_left_out(tmp_path: Path) -> None:
    here, coverage = Path(__file__).parent, (sys.executable, "-m", "coverage")
    data, report = f"--data-file={tmp_path / 'data'}", tmp_path / "report.json"
    tests = [str(here / name) for name in TESTS]
    run = [
        *coverage,
        "run",
        "--branch",
        data,
        "--source=firmware_sim",
        "-m",
        "pytest",
        "-p",
        "no:cacheprovider",
    ]
    done = subprocess.run([*run, *tests], capture_output=True, text=True, check=False, cwd=here.parents[1])
    assert done.returncode == 0, done.stdout
    subprocess.run([*coverage, "json", data, "-o", str(report)], capture_output=True, check=True)
    files = json.loads(report.read_text())["files"]
    found = {Path(name).name: file for name, file in files.items()}
    left_out = {name: (found[name]["missing_lines"], found[name]["missing_branches"]) for name in WHOLE}
    assert left_out == {name: ([], []) for name in WHOLE}
    assert found["axis.py"]["summary"]["num_branches"] > 60
