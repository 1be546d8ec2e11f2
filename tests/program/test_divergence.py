"""An estimator that has lost its numbers ends the run, whatever controller listens to it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from hilbed import loop
from hilbed.types import Diverged, Estimate, Nanos, Odometry, Reading
from tests.loop.fakes import Adder, rig


@pytest.mark.parametrize("number", [np.nan, np.inf])
@pytest.mark.parametrize("bad", ["mean", "covariance"])
def test_an_estimate_that_is_not_finite_ends_the_run(
    bad: str, number: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    def lost(_: Adder, t: Nanos, __: Odometry, ___: Sequence[Reading]) -> Estimate:
        mean, covariance = np.zeros(3), np.eye(3)
        if t == 20:
            {"mean": mean, "covariance": covariance}[bad][..., 1] = number
        return Estimate(t, mean, covariance)

    monkeypatch.setattr(Adder, "step", lost)
    parts, world, _ = rig()
    cycles = loop.run(parts, 50)
    assert [next(cycles).t, next(cycles).t] == [0, 10]
    with pytest.raises(Diverged, match="estimate is not finite"):
        next(cycles)
    assert world.now == 20
