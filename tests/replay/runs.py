"""A short run with camera, load and slip, recorded once for all tests that need one."""

from __future__ import annotations

import atexit
from functools import cache
from pathlib import Path
from shutil import rmtree
from tempfile import mkdtemp

from hilbed.record.folder import RunFolder
from hilbed.runner import perform
from hilbed.scenario.load import load

SHORT = ("duration=3", "disturbances=[{kind: load_torque, drive: left, start: 1, length: 1, size: 3}]")


@cache
def recorded(*settings: str) -> Path:
    """Returns the folder of a three-second demo with `settings` laid over it; not to be written to."""
    place = Path(mkdtemp(prefix="hilbed-run-"))
    atexit.register(rmtree, place, ignore_errors=True)
    folder = place / "run"
    perform(load("demo", [*SHORT, *settings], seed=3), RunFolder(folder))
    return folder
