"""What is kept of a run as its golden record, and where.

A record is a handful of rows, one every half second, and all numbers that the run is measured by. Of a
recorded robot only aggregate numbers are kept: its log is not ours to publish.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from math import isfinite
from pathlib import Path
from typing import Any

import numpy as np

from tests.bench import Ran, ran

FOLDER = Path(__file__).parent / "records"

# Long enough for every disturbance to act; what comes late in a scenario is brought forward.
SETTINGS: dict[str, tuple[str, ...]] = {
    "demo": (),
    "slimane2014/duty": (
        "duration=14", "disturbances.1.start=3", "disturbances.2.start=6", "disturbances.3.start=7",
    ),
    "slimane2014/load-torque": (),
    "slimane2014/localisation-1": ("duration=6",),
    "slimane2014/localisation-2": ("duration=8", "disturbances.2.start=2", "disturbances.3.start=3"),
    "slimane2014/tracking-circle": ("duration=6",),
    "slimane2014/tracking-circle-open": ("duration=6",),
    "slimane2014/tracking-line": ("duration=6",),
    "slimane2014/tracking-line-open": ("duration=6",),
    "slimane2014/tracking-stadium": ("duration=13",),
    "slimane2014/tracking-stadium-open": ("duration=13",),
    "recorded/azimuth": ("duration=120",),
    "recorded/range-azimuth": ("duration=120",),
}  # fmt: skip

AGGREGATES = (
    "estimate_position_rms", "estimate_yaw_rms", "odometry_position_rms", "nees_mean", "nis_mean",
    "accepted_fraction", "azimuth_count", "range_std",
)  # fmt: skip

STEP = 0.5  # s between rows
DIGITS = 10

Record = dict[str, Any]
"""scenario, settings; times (N,) s; signals: (N,) each; numbers by name. NaN is None."""


def take(name: str, *changes: str) -> Record:
    """Runs a scenario, with `PATH=VALUE` changes if any, and returns its record."""
    run = ran(name, *SETTINGS[name], *changes)
    assert run.status < 2, run.verdict["reason"]
    if name.startswith("recorded/"):
        numbers = {key: value for key, value in run.metrics.items() if key in AGGREGATES}
        return _record(name, np.empty(0), {}, numbers)
    every = round(STEP / run.signals["t"][1])
    signals = {key: column[::every] for key, column in columns(run.signals).items()}
    return _record(name, run.signals["t"][::every], signals, numbers_of(run))


def columns(signals: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Returns the columns (N,) worth keeping, poses and commands taken apart."""
    kept = {}
    for name, parts in (
        ("truth", ("x", "y", "yaw")),
        ("odometry", ("x", "y", "yaw")),
        ("estimate", ("x", "y", "yaw")),
        ("reference", ("x", "y", "yaw")),
        ("command", ("v", "w")),
    ):
        kept |= {f"{name}/{part}": signals[name][:, k] for k, part in enumerate(parts)}
    deviations = np.sqrt(np.diagonal(signals["covariance"], axis1=1, axis2=2))
    kept |= {f"deviation/{part}": deviations[:, k] for k, part in enumerate(("x", "y", "yaw"))}
    drives = [name for name in signals if name.startswith("drive/")]
    return kept | {name: signals[name] for name in sorted(drives)}


def numbers_of(run: Ran) -> dict[str, float]:
    """Returns everything that the run is measured by, and sums over its readings and innovations."""
    signals = run.signals
    sums = {"nis/sum": signals["nis/value"].sum()} if "nis/value" in signals else {}
    if "azimuth/measured" in signals:
        sums["azimuth/sum"] = signals["azimuth/measured"].sum()
    return {**run.metrics, **sums}


def path(name: str) -> Path:
    """Returns the file of a scenario's record."""
    return FOLDER / f"{name.replace('/', '--')}.json"


def read(name: str) -> Record:
    """Returns the golden record of a scenario."""
    record: Record = json.loads(path(name).read_text())
    return record


def write(name: str, record: Record) -> None:
    """Writes a record with one signal or number a line, so that a diff can be read."""
    lines = [f' "{key}": {json.dumps(record[key])},' for key in ("scenario", "settings", "times")]
    lines += [f' "signals": {_block(record["signals"])},', f' "numbers": {_block(record["numbers"])}']
    path(name).write_text("\n".join(["{", *lines, "}"]) + "\n")


def _block(rows: Mapping[str, Any]) -> str:
    inner = ",\n".join(f"  {json.dumps(key)}: {json.dumps(value)}" for key, value in rows.items())
    return f"{{\n{inner}\n }}" if rows else "{}"


def _record(
    name: str, times: np.ndarray, signals: Mapping[str, np.ndarray], numbers: Mapping[str, float]
) -> Record:
    return {
        "scenario": name,
        "settings": list(SETTINGS[name]),
        "times": [_rounded(t) for t in times],
        "signals": {key: [_rounded(v) for v in column] for key, column in signals.items()},
        "numbers": {key: _rounded(value) for key, value in numbers.items()},
    }


def _rounded(value: float) -> float | None:
    return float(f"{value:.{DIGITS}g}") if isfinite(value) else None
