"""The real robot through the whole program: limits of the first issue, on the half that was not fitted."""

from __future__ import annotations

import numpy as np
import pytest

from tests.bench import Ran, needs_data, ran

pytestmark = needs_data


def second_half(run: Ran) -> float:
    """Returns the rms error (m) of what the fit has not seen, without the metrics' code."""
    error = (run.signals["estimate"] - run.signals["truth"])[run.signals["t"] >= 315.2, :2]
    return float(np.sqrt(np.nanmean(np.sum(error**2, axis=1))))


@pytest.mark.parametrize(
    ("name", "metres", "nees"), [("recorded/azimuth", 0.15, 15.0), ("recorded/range-azimuth", 0.07, 40.0)]
)
def test_it_meets_its_limits_and_the_plain_filter_does_not(name: str, metres: float, nees: float) -> None:
    fitted, plain = ran(name), ran(name, "estimator=ekf")
    criteria = fitted.verdict["criteria"]
    values = {key: body["value"] for key, body in criteria.items()}
    assert fitted.status == 0
    assert values["estimate_position_rms"] == pytest.approx(second_half(fitted), rel=1e-9)
    assert all(body["passed"] for body in criteria.values())
    assert values["estimate_position_rms"] <= metres
    assert values["estimate_yaw_rms"] <= 0.05
    assert values["nees_mean"] <= nees
    assert plain.status == 1
    for metric in ("estimate_position_rms", "estimate_yaw_rms"):
        assert plain.verdict["criteria"][metric]["value"] > 3.0 * values[metric]
    assert plain.verdict["criteria"]["nees_mean"]["value"] > 100.0
