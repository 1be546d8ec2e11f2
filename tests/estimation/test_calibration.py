"""What was put into a simulated run comes out of the fit."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from hilbed import yaml12
from hilbed.estimation.calibration import increments
from hilbed.estimation.specs import EkfSpec
from hilbed.fit import Fitted, first_part, fit_signals, lines
from hilbed.poses import moved
from hilbed.types import Pose, ScenarioError
from tests.estimation.experiment import BEACONS, PERIOD, START, Errors, Step, experiment

KINDS = ("azimuth", "range")
WRONG = Errors(
    direction=-0.06,
    distance_scale=0.97,
    turn_scale=1.04,
    distance_noise=0.04,
    heading_noise=0.05,
    turn_noise=0.02,
    mount=(0.22, -0.03),
    delay=0.1,
    azimuth_std=0.012,
    azimuth_bias=0.01,
    range_std=0.025,
    range_bias=-0.015,
)


def signals(steps: list[Step]) -> dict[str, np.ndarray]:
    """The run as signals.npz has it."""
    pose, reckoned = START, []
    for step in steps:
        pose = moved(pose, step.odometry.distance, step.odometry.turn)
        reckoned.append(pose)
    table = {
        "t": np.array([step.t for step in steps]) * 1e-9,
        "truth": np.array([step.truth for step in steps]),
        "odometry": np.array(reckoned),
    }
    for kind in KINDS:
        rows = [r for step in steps for r in step.readings if r.kind == kind]
        table |= {
            f"{kind}/t": np.array([r.t for r in rows]) * 1e-9,
            f"{kind}/delivered": np.array([r.delivered for r in rows]) * 1e-9,
            f"{kind}/beacon": np.array([r.beacon for r in rows]),
            f"{kind}/measured": np.array([r.value[0] for r in rows]),
        }
    return table


@pytest.fixture(scope="module")
def fitted() -> Fitted:
    table = signals(experiment(7, 2400, WRONG, KINDS))
    table["azimuth/beacon"][::20] = -1
    table["azimuth/measured"][::20] = 3.0
    table["truth"][500:520] = np.nan
    return fit_signals(table, BEACONS)


def test_systematic_errors_come_out(fitted: Fitted) -> None:
    spec = fitted.spec
    assert spec.odometry.direction == pytest.approx(-0.06, abs=5e-3)
    assert spec.odometry.distance_scale == pytest.approx(0.97, abs=0.01)
    assert spec.odometry.turn_scale == pytest.approx(1.04, abs=0.02)
    assert spec.delay == pytest.approx(0.1, abs=5e-3)
    assert spec.mount == pytest.approx((0.22, -0.03), abs=5e-3)
    assert spec.azimuth.bias == pytest.approx(0.01, abs=2e-3)
    assert spec.range.bias == pytest.approx(-0.015, abs=3e-3)


def test_noise_comes_out_and_white_noise_is_left_alone(fitted: Fitted) -> None:
    _, azimuth, _, count = fitted.sensor.kinds["azimuth"]
    assert azimuth == pytest.approx(0.012, rel=0.08)
    assert fitted.sensor.kinds["range"][1] == pytest.approx(0.025, rel=0.08)
    assert count < 0.95 * 2400
    assert 0.65 < fitted.readings < 1.5
    assert 0.65 < fitted.odometry < 1.5
    assert fitted.spec.odometry.distance_noise / fitted.odometry == pytest.approx(0.04, rel=0.25)


def test_lines_are_a_block_of_a_scenario(fitted: Fitted) -> None:
    data, _ = yaml12.read("\n".join(lines(fitted.spec)), "fit")
    assert EkfSpec.model_validate(data["estimator"]) == fitted.spec


def test_only_the_first_part_is_looked_at() -> None:
    table = signals(experiment(7, 400, WRONG, KINDS))
    part = first_part(table, 0.25)
    assert len(part["t"]) == 100
    assert part["azimuth/delivered"].max() <= part["t"][-1]
    spoilt = {
        key: np.where(np.arange(len(a)) < len(a) // 4, a.T, 1e3).T
        for key, a in table.items()
        if "/" not in key
    }
    np.testing.assert_array_equal(first_part({**table, **spoilt}, 0.25)["truth"], part["truth"])


def test_increments_undo_integration() -> None:
    ways = [(0.1, 0.3), (0.2, -0.5), (-0.1, 0.2), (0.0, 3.0), (0.3, 2.9)]
    poses = [Pose(1.0, 2.0, pi - 0.1)]
    for way, turn in ways:
        poses.append(moved(poses[-1], way, turn))
    told = increments(np.array(poses))
    np.testing.assert_allclose(told[:, [0, 2]], ways, atol=1e-12)
    np.testing.assert_allclose(told[:, 1], 0, atol=1e-12)


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda table: table["truth"].fill(np.nan), "no truth"),
        (lambda table: table.update(first_part(table, 0.2)), "less than 5 s"),
        (lambda table: [table.pop(key) for key in list(table) if "/" in key], "fewer than 20"),
        (lambda table: table["azimuth/beacon"].fill(-1) or table["range/beacon"].fill(-1), "fewer than 20"),
    ],
)
def test_a_run_that_tells_nothing_is_refused(spoil: object, words: str) -> None:
    table = signals(experiment(1, 200, WRONG, KINDS))
    spoil(table)  # type: ignore[operator]
    with pytest.raises(ScenarioError, match=words):
        fit_signals(table, BEACONS)


def test_the_period_of_the_experiment_divides_its_delay() -> None:
    assert round(WRONG.delay * 1e9) % PERIOD == 0
