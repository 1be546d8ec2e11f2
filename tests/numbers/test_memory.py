"""Memory stays flat, within a run with all recorders on and from run to run; peak below 400 MB."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from tests.numbers import memory


def measured(function: str, folder: Path) -> dict[str, float]:
    """Returns what tests/numbers/memory.py finds in a process of its own."""
    command = [sys.executable, "-m", memory.__name__, function, str(folder)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=200, check=True)
    content: dict[str, float] = json.loads(done.stdout)
    return content


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="no /proc to read memory from")
@pytest.mark.parametrize(
    ("function", "growth"),
    [("within", 8.0), ("between", 2.0)],  # signals alone take 3 MB in 10 s; frames would take 12
)
def test_memory_is_flat(function: str, growth: float, tmp_path: Path) -> None:
    found = measured(function, tmp_path)
    assert found["later"] - found["early"] < growth, found
    assert found["peak"] < 400.0
