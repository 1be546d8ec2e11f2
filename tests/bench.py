"""The bench in this process, for tests that look at the signals of a run; whether there is recorded data."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np
import pytest

from hilbed.record.folder import RunFolder
from hilbed.runner import perform
from hilbed.scenario.load import load

_DATA = os.environ.get("HILBED_DATA", "")
needs_data = pytest.mark.skipif(
    not (_DATA and Path(_DATA, "woods.npz").is_file()), reason="HILBED_DATA names no folder with woods.npz"
)


class Ran(NamedTuple):
    """Exit status, content of verdict.json and of signals.npz of a run."""

    status: int
    verdict: Mapping[str, Any]
    signals: dict[str, np.ndarray[Any, Any]]

    @property
    def metrics(self) -> dict[str, float]:
        """What the run was measured by; NaN where a number is missing."""
        return {name: np.nan if v is None else v for name, v in self.verdict["metrics"].items()}


def ran(scenario: str | Path, *settings: str, seed: int | None = None) -> Ran:
    """Runs a scenario with `PATH=VALUE` settings to its end."""
    with TemporaryDirectory() as folder:
        loaded = load(str(scenario), [*settings, "record=signals"], seed)
        outcome = perform(loaded, RunFolder(Path(folder)))
        with np.load(Path(folder) / "signals.npz") as signals:
            return Ran(outcome.status, outcome.verdict, dict(signals))
