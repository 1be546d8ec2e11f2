"""The numbers by which a detector is judged, and whether they keep their limits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isfinite, nan
from typing import Any

import numpy as np

from hilbed.types import Array
from hilbed.vision.judging import MEASURES, LimitSpec
from hilbed.vision_kit.matching import Sighting
from hilbed.vision_kit.trial import Trial


def measure(trial: Trial) -> dict[str, float]:
    """Returns every measure by its name; NaN where there is nothing to take it from."""
    found = [one for one in trial.sightings if one.found]
    due = [one for one in trial.sightings if trial.rules.due(one)]
    wrong = sum(one.mistaken for one in found)
    detections = len(found) + len(trial.strays)
    values = {
        "frames": float(trial.frames),
        "failed_frames": float(len(trial.failed)),
        "beacons": float(len(due)),
        "detections": float(detections),
        "recall": _share(sum(one.found for one in due), len(due)),
        "precision": _share(len(found) - wrong, detections),
        "false_per_frame": _share(len(trial.strays), trial.frames),
        "wrong_identities": float(wrong),
        **_azimuth([one for one in found if trial.rules.reaches(one)]),
        **_times(trial.seconds),
    }
    assert list(values) == list(MEASURES), "each measure has a name that is known"
    return values


def _share(part: float, whole: float) -> float:
    return part / whole if whole else nan


def _azimuth(found: Sequence[Sighting]) -> dict[str, float]:
    error = 1000 * np.degrees(np.array([one.error for one in found]))
    px = np.array([one.error_px for one in found])
    std = 1000 * np.degrees(np.array([one.std for one in found]))
    return {
        "azimuth_bias_mdeg": _or_nan(np.mean, error),
        "azimuth_std_mdeg": _or_nan(np.std, error),
        "azimuth_rms_mdeg": _or_nan(lambda x: np.sqrt(np.mean(x * x)), error),
        "azimuth_max_mdeg": _or_nan(lambda x: np.max(np.abs(x)), error),
        "azimuth_bias_px": _or_nan(np.mean, px),
        "azimuth_std_px": _or_nan(np.std, px),
        "normalised_rms": _or_nan(lambda x: np.sqrt(np.mean(x * x)), error / std),
    }


def _or_nan(function: Any, values: Array) -> float:
    return float(function(values)) if values.size else nan


def _times(seconds: Sequence[float]) -> dict[str, float]:
    parts = {"time_p50_ms": 50, "time_p95_ms": 95, "time_p99_ms": 99}
    return {
        name: 1000 * float(np.percentile(seconds, part)) if seconds else nan for name, part in parts.items()
    }


def judge(values: Mapping[str, float], criteria: Mapping[str, LimitSpec]) -> dict[str, dict[str, Any]]:
    """Returns value, limit, bound and whether it is kept, as verdict.json has them, of every criterion.

    One with two limits makes two entries. What is not a number keeps no limit.
    """
    judged = {}
    for name, spec in criteria.items():
        both = spec.max is not None and spec.min is not None
        for bound, limit in (("max", spec.max), ("min", spec.min)):
            if limit is not None:
                judged[f"{name} ({bound})" if both else name] = _entry(values[name], bound, limit)
    return judged


def _entry(value: float, bound: str, limit: float) -> dict[str, Any]:
    passed = isfinite(value) and (value <= limit if bound == "max" else value >= limit)
    shown = value if isfinite(value) else None
    entry: dict[str, Any] = {"value": shown, "limit": limit, "passed": passed, "bound": bound}
    if not passed:
        word = "above" if bound == "max" else "below"
        entry["reason"] = "nothing to judge" if shown is None else f"{value:.4g} is {word} {limit:.4g}"
    return entry
