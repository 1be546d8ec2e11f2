from __future__ import annotations

from math import pi

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from hilbed.estimation.importance import importance, squared_distances

STD = (0.1, 0.2, 0.05)


@pytest.mark.parametrize("size", [2, 3])
def test_weights_are_proportional_to_the_normal_density(size: int) -> None:
    cloud = np.random.default_rng(1).normal(size=(50, 3)) * 0.1
    value = (0.05, -0.1, 0.02)[:size]
    weights = importance(squared_distances(cloud, value, STD[:size]))
    assert weights is not None
    density = multivariate_normal(value, np.diag(np.square(STD[:size]))).pdf(cloud[:, :size])
    np.testing.assert_allclose(weights / weights.sum(), density / density.sum(), rtol=1e-9)


def test_the_yaw_innovation_is_wrapped() -> None:
    cloud = np.array([(0.0, 0.0, pi - 0.01), (0.0, 0.0, -pi + 0.03)])
    np.testing.assert_allclose(squared_distances(cloud, (0, 0, -pi + 0.01), STD), [0.16, 0.16])


def test_weights_that_would_all_round_to_zero_are_none() -> None:
    """exp(−745) is the smallest number above zero."""
    assert np.exp(-1489 / 2) > 0
    assert np.exp(-1491 / 2) == 0
    assert importance(np.array([1491.0, 1e300, np.inf])) is None
    assert importance(np.array([np.nan])) is None
    weights = importance(np.array([1489.0, 1491.0, np.inf]))
    assert weights is not None
    np.testing.assert_allclose(weights, [1, np.exp(-1), 0])
