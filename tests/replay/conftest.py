"""Copies of recorded runs that a test may break."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.replay.runs import recorded


@pytest.fixture
def run(tmp_path: Path) -> Path:
    """Returns a run folder of the test's own."""
    copy = tmp_path / "run"
    shutil.copytree(recorded(), copy)
    return copy
