"""A short run with camera, load and slip, recorded once for all tests that need one."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from tempfile import mkdtemp

from hilbed.record.folder import RunFolder
from hilbed.runner import perform
from hilbed.scenario.load import load

SHORT = ("duration=3", "disturbances=[{kind: load_torque, drive: left, start: 1, length: 1, size: 3}]")


@cache
def recorded(*settings: str) -> Path:
    """Returns the folder of a three-second demo with `settings` laid over it; not to be written to."""
    folder = Path(mkdtemp(prefix="hilbed-run-")) / "run"
    perform(load("demo", [*SHORT, *settings], seed=3), RunFolder(folder))
    return folder
