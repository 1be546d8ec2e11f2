"""Recorded readings, from the columns of signals.npz back to what the estimator got."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from hilbed.clock import SECOND
from hilbed.record.folder import SIGNALS
from hilbed.types import Nanos, Reading, ScenarioError

Signals = Mapping[str, npt.NDArray[Any]]


def readings(signals: Signals, kind: str) -> list[Reading]:
    """Returns the recorded readings of one kind as the estimator got them, in the order of delivery."""
    columns = [f"{kind}/{name}" for name in ("t", "delivered", "measured", "std", "claimed")]
    lacking = [name for name in columns if name not in signals]
    if lacking:
        raise ScenarioError(f"{SIGNALS} has no {lacking[0]}: it was recorded by an older hilbed")
    t, delivered = (_nanos(signals[name]) for name in columns[:2])
    values, stds = (numbers_of(signals[name]) for name in columns[2:4])
    claimed = signals[columns[4]].tolist()
    return [
        Reading(kind, at, arrival, value, std, None if beacon < 0 else beacon)
        for at, arrival, value, std, beacon in zip(t, delivered, values, stds, claimed, strict=True)
    ]


def kinds(signals: Signals) -> list[str]:
    """Returns the kinds of readings that were recorded."""
    return [name.removesuffix("/delivered") for name in signals if name.endswith("/delivered")]


def _nanos(seconds: npt.NDArray[Any]) -> list[Nanos]:
    return [round(stamp * SECOND) for stamp in seconds.tolist()]


def numbers_of(values: npt.NDArray[Any]) -> list[tuple[float, ...]]:
    """Returns the numbers of each reading from a column (K,) or (K, size), where K may be 0."""
    return [tuple(np.atleast_1d(row).tolist()) for row in values]
