"""The real robot through the whole program: limits of the first issue, on the half that was not fitted."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tests.bench import ran

DATA = os.environ.get("HILBED_DATA", "")
pytestmark = pytest.mark.skipif(
    not (DATA and Path(DATA, "woods.npz").is_file()), reason="HILBED_DATA names no folder with woods.npz"
)


@pytest.mark.parametrize(
    ("name", "metres", "nees"), [("recorded/azimuth", 0.15, 15.0), ("recorded/range-azimuth", 0.07, 40.0)]
)
def test_it_meets_its_limits_and_the_plain_filter_does_not(name: str, metres: float, nees: float) -> None:
    fitted, plain = ran(name), ran(name, "estimator=ekf")
    criteria = fitted.verdict["criteria"]
    values = {key: body["value"] for key, body in criteria.items()}
    assert fitted.status == 0
    assert all(body["passed"] for body in criteria.values())
    assert values["estimate_position_rms"] <= metres
    assert values["estimate_yaw_rms"] <= 0.05
    assert values["nees_mean"] <= nees
    assert plain.status == 1
    for metric in ("estimate_position_rms", "estimate_yaw_rms"):
        assert plain.verdict["criteria"][metric]["value"] > 3.0 * values[metric]
    assert plain.verdict["criteria"]["nees_mean"]["value"] > 100.0


def test_the_second_half_is_what_is_judged() -> None:
    run = ran("recorded/azimuth", "duration=400")
    t = run.signals["t"]
    half = t >= 315.2
    error = (run.signals["estimate"] - run.signals["truth"])[half, :2]
    known = error[~(error != error).any(axis=1)]
    rms = float(((known**2).sum(axis=1).mean()) ** 0.5)
    assert run.verdict["criteria"]["estimate_position_rms"]["value"] == pytest.approx(rms, rel=1e-9)
