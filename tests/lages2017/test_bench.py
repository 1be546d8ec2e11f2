"""What the bench of particles measures is what it says: the clouds of the run, and the exact selection."""

from __future__ import annotations

import numpy as np
import pytest

from hilbed.bench_particles import GOAL, Timed, cloud_at, commands, cycle_times, table, told_run
from hilbed.control.support import most_supported
from hilbed.types import Array
from tests.lages2017.experiment import experiment

TOLD = told_run(301)


def counts(x: Array, y: Array) -> Array:
    dx, dy = x[:, None] - x, y[:, None] - y
    return np.asarray(np.count_nonzero(dx * dx + dy * dy < 1, axis=1))


def test_its_run_is_the_papers_experiment() -> None:
    for told, moment in zip(TOLD, experiment(1), strict=False):
        np.testing.assert_array_equal(told.belief, moment.estimate.mean)


@pytest.mark.parametrize("k", [0, 1, 3, 50, 100, 200, 300])
@pytest.mark.parametrize("guard", [0.0, 0.05])
@pytest.mark.parametrize("count", [900, 1000])
def test_selection_of_the_runs_clouds_is_that_of_all_pairs(k: int, guard: float, count: int) -> None:
    x, y = commands(cloud_at(TOLD, k, count), guard)
    assert most_supported(x, y) == np.argmax(counts(x, y))


@pytest.mark.parametrize("k", [0, 300])
def test_a_filter_of_another_size_has_the_same_belief(k: int) -> None:
    """Ten thousand particles and nine hundred see the same readings; near the goal they agree to a few cm."""
    few, many = cloud_at(TOLD, k, 900), cloud_at(TOLD, k, 10_000)
    np.testing.assert_allclose(few.mean(axis=0), many.mean(axis=0), atol=0.03)
    assert np.hypot(*(TOLD[300].belief[:2] - np.array(GOAL[:2]))) < 0.3


def test_the_table_has_a_line_for_each_stage_and_one_for_the_cycle() -> None:
    stages = [Timed("law", 1e-4, 1e-4, 1e-2), Timed("selection, first", 2e-4, 2e-4, 4e-2, 1e-3)]
    law, selection, stages_in_all, cycle = table(stages, [1e-4, 2e-4, 3e-4]).splitlines()[1:]
    assert law.split() == ["law,", "ms", "0.100", "0.100", "10.000", "100"]
    assert selection.split()[-3:] == ["200", "1.000", "0.20"]
    assert stages_in_all.endswith("0.30 ms")
    assert "over 3 cycles of a run: 0.20 ms (median), 0.29 ms (95 %)" in cycle


def test_a_cycle_is_measured_for_each_of_the_run() -> None:
    times = cycle_times(TOLD[:20])
    assert len(times) == 20
    assert min(times) > 0
