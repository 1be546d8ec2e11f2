"""Tables 2 and 3: where the runs end, beside what is printed."""

from __future__ import annotations

import numpy as np
import pytest

from hilbed.angles import wrap
from hilbed.types import Array
from tests.lages2017.experiment import GOAL, STARTS, final

RUNS = 50
TRIES = 5


def errors(poses: list[tuple[float, float, float]]) -> Array:
    """Returns end − goal (N, 3)."""
    return np.array([(x - GOAL.x, y - GOAL.y, wrap(yaw - GOAL.yaw)) for x, y, yaw in poses])


def judge(error: Array) -> None:
    assert np.abs(error[:, :2].mean(axis=0)).max() < 0.015
    assert abs(error[:, 2].mean()) < 0.001
    assert (error[:, :2].std(axis=0, ddof=1) > 0.009).all()
    assert (error[:, :2].std(axis=0, ddof=1) < 0.03).all()
    assert np.hypot(error[:, 0], error[:, 1]).max() < 0.1
    assert np.abs(error[:, 2]).max() < 0.1


@pytest.mark.slow
@pytest.mark.timeout(1200)
def test_table_2() -> None:
    """Printed: mean (0.9973, 3.0027, −1.5708), standard deviation (0.0203, 0.0139, 0.0014)."""
    judge(errors([final(seed) for seed in range(RUNS)]))


@pytest.mark.slow
@pytest.mark.timeout(1200)
def test_table_3() -> None:
    """Printed: mean (1.0026, 2.9949, −1.5706), standard deviation (0.0212, 0.0109, 0.0014)."""
    runs = [(100 + 8 * k + j, start) for k in range(TRIES) for j, start in enumerate(STARTS)]
    judge(errors([final(seed, start) for seed, start in runs]))
