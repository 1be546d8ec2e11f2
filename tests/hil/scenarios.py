"""A scenario short enough for a user-mode kernel: no camera, straight ahead."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

SHORT = """\
# Straight ahead, up to 0.25 m/s
seed: 3
duration: 0.5
plant: {kind: bullet}
estimator: odometry
controller: open_loop
reference: {kind: line, acceleration: 0.5}
"""


def short(folder: Path) -> Path:
    """Writes the scenario into a folder and returns its file."""
    file = folder / "short.yaml"
    file.write_text(SHORT)
    return file


def verdict(run: Path) -> dict[str, Any]:
    """Returns what a run folder's verdict.json says."""
    content: dict[str, Any] = json.loads((run / "verdict.json").read_text())
    return content
