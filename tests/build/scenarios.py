"""A small scenario that tests change by `PATH=VALUE`: straight ahead at 0.5 m/s among four beacons."""

from __future__ import annotations

from pathlib import Path

SMALL = """\
# Straight ahead among four beacons
seed: 3
duration: 1
period: 0.01
plant:
  kind: bullet
  beacons:
    - {at: [4, 0.5], colour: red}
    - {at: [3, -2], colour: green}
    - {at: [3, 2], colour: blue}
    - {at: [-3, 0], colour: magenta}
sensors:
  camera: {kind: camera}
estimator: ekf
controller: lqr
reference: {kind: line, acceleration: 0.5}
"""


def small(folder: Path) -> Path:
    """Writes the scenario into a folder and returns its file."""
    file = folder / "small.yaml"
    file.write_text(SMALL)
    return file
