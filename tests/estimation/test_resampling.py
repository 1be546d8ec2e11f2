from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import chisquare

from hilbed.estimation.resampling import (
    RESAMPLERS,
    Indices,
    effective_sample_size,
    multinomial,
    systematic,
)

WEIGHTS = np.array([0.1, 0.0, 0.4, 0.2, 0.0, 0.3, 0.0])
weights = st.lists(st.one_of(st.just(0.0), st.floats(1e-300, 1e300)), min_size=1, max_size=60).filter(any)


def counts(name: str, seed: int, times: int) -> Indices:
    rng = np.random.default_rng(seed)
    return np.array(
        [np.bincount(RESAMPLERS[name](WEIGHTS, rng), minlength=len(WEIGHTS)) for _ in range(times)]
    )


@pytest.mark.parametrize("name", RESAMPLERS)
@given(weights, st.integers(0, 2**32 - 1))
def test_as_many_as_there_were_and_none_without_weight(name: str, w: list[float], seed: int) -> None:
    chosen = RESAMPLERS[name](np.array(w), np.random.default_rng(seed))
    assert len(chosen) == len(w)
    assert (np.diff(chosen) >= 0).all()
    assert (np.array(w)[chosen] > 0).all()


def test_multinomial_counts_have_mean_and_variance_of_independent_draws() -> None:
    """Mean M w, covariance M (diag w − w wᵀ); 20 000 repetitions, so five standard errors are 2 %."""
    drawn, M = counts("multinomial", 1, 20_000), len(WEIGHTS)
    live = WEIGHTS > 0
    assert chisquare(drawn.sum(0)[live], M * WEIGHTS[live] * len(drawn)).pvalue > 1e-3
    expected = M * (np.diag(WEIGHTS) - np.outer(WEIGHTS, WEIGHTS))
    np.testing.assert_allclose(np.cov(drawn.T), expected, atol=0.06)


@given(weights, st.integers(0, 2**32 - 1))
def test_systematic_counts_are_the_expected_ones_rounded_down_or_up(w: list[float], seed: int) -> None:
    share = np.array(w) / max(w)
    expected = len(w) * share / share.sum()
    drawn = np.bincount(systematic(share, np.random.default_rng(seed)), minlength=len(w))
    assert (drawn >= np.floor(expected - 1e-9)).all()
    assert (drawn <= np.ceil(expected + 1e-9)).all()


def test_systematic_is_unbiased() -> None:
    drawn = counts("systematic", 2, 20_000)
    np.testing.assert_allclose(drawn.mean(0), len(WEIGHTS) * WEIGHTS, atol=0.02)


def test_effective_sample_size_of_equal_one_and_half() -> None:
    assert effective_sample_size(np.full(900, 0.3)) == pytest.approx(900)
    assert effective_sample_size(np.eye(900)[7]) == pytest.approx(1)
    assert effective_sample_size(np.tile((0.0, 1.0), 450)) == pytest.approx(450)


def test_same_seed_same_draw() -> None:
    first, second = (multinomial(WEIGHTS, np.random.default_rng(3)) for _ in range(2))
    np.testing.assert_array_equal(first, second)
