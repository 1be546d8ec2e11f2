"""Measures of detections whose errors are known, and criteria on them."""

from __future__ import annotations

from math import degrees, isnan, nan, radians

import numpy as np
import pytest
from pydantic import ValidationError

from hilbed.vision.judging import MEASURES, LimitSpec, VisionSpec
from hilbed.vision_kit.matching import Sighting, Stray
from hilbed.vision_kit.measures import judge, measure
from hilbed.vision_kit.trial import Rules, Trial

RULES = Rules(0.25, (1.0, 8.0))


def sighting(**fields: object) -> Sighting:
    plain = Sighting(0, 0.9, 0, 5.0, 1.0, 0.0, cut=False)
    return plain._replace(**fields)  # type: ignore[arg-type]


def trial(sightings: list[Sighting], strays: int = 0, seconds: list[float] | None = None) -> Trial:
    lost = [Stray(0, 0.9, k, 5.0, 1.0) for k in range(strays)]
    return Trial(RULES, sightings, lost, seconds or [0.001], {}, [])


def test_bias_and_spread_of_known_errors() -> None:
    rng = np.random.default_rng(3)
    std = radians(0.004)
    errors = radians(0.001) + std * rng.standard_normal(20_000)
    found = [sighting(found=True, error=e, error_px=320 * e, std=std, named=0) for e in errors.tolist()]
    values = measure(trial(found))
    assert values["azimuth_bias_mdeg"] == pytest.approx(1.0, abs=0.1)
    assert values["azimuth_std_mdeg"] == pytest.approx(4.0, rel=0.02)
    assert values["azimuth_rms_mdeg"] == pytest.approx(np.hypot(1.0, 4.0), rel=0.02)
    assert values["azimuth_max_mdeg"] == pytest.approx(1000 * degrees(np.abs(errors).max()))
    assert values["azimuth_std_px"] == pytest.approx(320 * std, rel=0.02)
    assert values["normalised_rms"] == pytest.approx(np.hypot(1.0, 0.25), rel=0.02)


def test_azimuths_are_judged_at_the_distance_alone() -> None:
    near = sighting(found=True, error=1e-4, error_px=0.03, std=1e-4)
    values = measure(trial([near, near._replace(distance=8.5, error=1e-2, error_px=3.0)]))
    assert values["azimuth_bias_mdeg"] == pytest.approx(1000 * degrees(1e-4))
    assert values["azimuth_bias_px"] == pytest.approx(0.03)


def test_recall_counts_what_is_due_alone() -> None:
    ones = [
        sighting(found=True, error=0.0, error_px=0.0, std=1e-4),
        sighting(),
        sighting(distance=0.9),
        sighting(distance=8.1),
        sighting(visible=0.24),
        sighting(cut=True),
        sighting(cut=True, found=True, error=0.0, error_px=0.0, std=1e-4),
    ]
    values = measure(trial(ones))
    assert (values["beacons"], values["recall"], values["detections"]) == (2, 0.5, 2)


def test_precision_takes_off_strays_and_wrong_identities() -> None:
    right = sighting(found=True, error=0.0, error_px=0.0, std=1e-4, named=0)
    ones = [right, right._replace(named=None), right._replace(named=3)]
    values = measure(trial(ones, strays=1, seconds=[0.001, 0.001]))
    assert values["precision"] == 0.5
    assert values["wrong_identities"] == 1
    assert values["false_per_frame"] == 0.5


def test_percentiles_of_time() -> None:
    values = measure(trial([], seconds=[0.001 * k for k in range(1, 102)]))
    assert (values["time_p50_ms"], values["time_p95_ms"], values["time_p99_ms"]) == pytest.approx(
        (51, 96, 100)
    )


def test_of_nothing_there_is_no_number() -> None:
    values = measure(trial([]))
    assert list(values) == list(MEASURES)
    assert all(isnan(values[name]) for name in ("recall", "precision", "azimuth_std_mdeg", "normalised_rms"))


@pytest.mark.parametrize(
    ("value", "spec", "passed"),
    [
        (1.0, {"min": 1.0}, [True]),
        (0.99, {"min": 1.0}, [False]),
        (5.0, {"max": 5.0}, [True]),
        (5.1, {"max": 5.0}, [False]),
        (1.4, {"min": 0.7, "max": 1.3}, [False, True]),
        (nan, {"max": 5.0}, [False]),
    ],
)
def test_limits(value: float, spec: dict[str, float], passed: list[bool]) -> None:
    judged = judge({"recall": value}, {"recall": LimitSpec.model_validate(spec)})
    assert [entry["passed"] for entry in judged.values()] == passed
    assert all("reason" in entry for entry in judged.values() if not entry["passed"])


@pytest.mark.parametrize(
    ("block", "told"),
    [
        ({"criteria": {"recal": {"min": 1}}}, "did you mean 'recall'"),
        ({"criteria": {"recall": {}}}, "needs max or min"),
        ({"criteria": {"recall": {"min": 1.0, "max": 0.5}}}, "nothing lies from 1 to 0.5"),
        ({"distance": [8, 1]}, "distances must increase"),
        ({"frames": 0}, "greater than or equal to 1"),
    ],
)
def test_a_block_that_cannot_be_is_told(block: dict[str, object], told: str) -> None:
    with pytest.raises(ValidationError, match=told):
        VisionSpec.model_validate(block)
