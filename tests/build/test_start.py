"""Where the robot starts, and where its estimator is told that it does."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from hilbed.build.known import start_of, told_of
from hilbed.scenario.load import load
from tests.bench import ran
from tests.build.scenarios import small

STD = (0.1, 0.2, 0.05)
SETTING = f"plant.start_std={list(STD)}"


def test_the_robot_stands_where_it_is_put_and_dead_reckoning_starts_where_it_is_told(tmp_path: Path) -> None:
    known, wrong = (
        ran(small(tmp_path), "duration=0.1", *settings, seed=3).signals for settings in ((), (SETTING,))
    )
    assert np.array_equal(wrong["truth"][0], known["truth"][0])
    assert np.array_equal(known["odometry"][0], known["truth"][0])
    off = wrong["odometry"][0] - wrong["truth"][0]
    assert (abs(off) > 0).all()
    assert (abs(off) < 5 * np.array(STD)).all()


@pytest.mark.parametrize("name", ["bui2022/ekf", "bui2022/ekf-bench"])
def test_what_it_is_told_has_the_spread_that_the_scenario_says(name: str) -> None:
    off = []
    for seed in range(400):
        scenario = load(name, [SETTING], seed).scenario
        start = start_of(scenario, None)
        off.append(np.subtract(told_of(scenario, start), start))
    assert np.std(off, axis=0) == pytest.approx(STD, rel=0.12)  # 3.4 σ of a standard deviation of 400
    assert (abs(np.mean(off, axis=0)) < 0.17 * np.array(STD)).all()
