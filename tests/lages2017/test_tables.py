"""Tables 2 and 3: where runs of the scenarios with the guarded law end, beside what is printed."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pytest

from hilbed.angles import wrap
from hilbed.scenario.load import load
from hilbed.types import Array
from tests.bench import ran
from tests.lages2017.experiment import GOAL

STARTS = [(4, 2, 2.5), (4, 4, 3), (2, 6, 1.9), (0, 6, 2.9), (-2, 4, np.pi), (-2, 2, 0), (0, 0, 2), (2, 0, 1)]


@pytest.mark.parametrize("law", ["", "-printed", "-bench"])
def test_the_scenarios_start_where_table_3_does(law: str) -> None:
    for k, start in enumerate(STARTS, 1):
        assert load(f"lages2017/start-{k}{law}").scenario.robot.start == pytest.approx(start)


def errors(runs: Iterable[tuple[str, int]]) -> Array:
    """Returns end − goal (N, 3) of scenarios with their seeds."""
    ends = [ran(f"lages2017/{name}", "criteria={}", seed=seed).signals["truth"][-1] for name, seed in runs]
    return np.array([(x - GOAL.x, y - GOAL.y, wrap(yaw - GOAL.yaw)) for x, y, yaw in ends])


def judge(error: Array) -> None:
    assert np.abs(error[:, :2].mean(axis=0)).max() < 0.015
    assert abs(error[:, 2].mean()) < 0.001
    std = error[:, :2].std(axis=0, ddof=1)
    assert (std > 0.009).all()
    assert (std < 0.03).all()
    assert np.hypot(error[:, 0], error[:, 1]).max() < 0.1
    assert np.abs(error[:, 2]).max() < 0.1


@pytest.mark.slow
@pytest.mark.timeout(1200)
def test_table_2() -> None:
    """Printed: mean (0.9973, 3.0027, −1.5708), standard deviation (0.0203, 0.0139, 0.0014)."""
    judge(errors(("single", seed) for seed in range(1, 51)))


@pytest.mark.slow
@pytest.mark.timeout(1200)
def test_table_3() -> None:
    """Printed: mean (1.0026, 2.9949, −1.5706), standard deviation (0.0212, 0.0109, 0.0014)."""
    judge(errors((f"start-{k}", seed) for seed in range(1, 6) for k in range(1, 9)))
