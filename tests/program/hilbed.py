"""`hilbed` as a user runs it: a process with its outputs and exit status."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import NamedTuple


class Ended(NamedTuple):
    """What a process left behind."""

    status: int
    out: str
    err: str


def hilbed(*arguments: str | Path, cwd: Path | None = None) -> Ended:
    """Runs a command to its end."""
    command = [sys.executable, "-m", "hilbed", *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, cwd=cwd, timeout=120, check=False)
    return Ended(done.returncode, done.stdout, done.stderr)
