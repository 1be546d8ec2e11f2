"""Small recordings for tests."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np


def arrays(**changes: Any) -> dict[str, Any]:
    """Ten rows at 10 Hz, two beacons; a key set to None is left out."""
    rng = np.random.default_rng(0)
    table = {
        "t": 5.0 + np.arange(10) / 10,
        "v": np.linspace(0.1, 0.5, 10),
        "omega": np.linspace(-0.2, 0.2, 10),
        "landmarks": np.array([[3.0, 1.0], [-2.0, 0.5]]),
        "range": np.tile([[2.5, 0.0]], (10, 1)) + rng.normal(0, 0.01, (10, 2)) * [1, 0],
        "bearing": np.tile([[0.3, 3.3]], (10, 1)),
        "truth": np.column_stack((np.arange(10) / 10, np.zeros(10), np.linspace(3.0, 3.4, 10))),
        "truth_valid": np.array([1, 1, 1, 0, 1, 1, 1, 1, 1, 1]),
        "sensor_offset": np.array(0.2),
        "range_variance": np.array(0.0009),
        "bearing_variance": np.array(0.0004),
    }
    return {key: value for key, value in {**table, **changes}.items() if value is not None}


def write(folder: Path, **changes: Any) -> Path:
    path = folder / "robot.npz"
    np.savez(path, **arrays(**changes))
    return path
