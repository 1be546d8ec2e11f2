"""Drawing particles by their weights: multinomial or systematic."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from hilbed.types import Array, Rng

Indices: TypeAlias = npt.NDArray[np.intp]


def multinomial(weights: Array, rng: Rng) -> Indices:
    """Returns M indices (M,), ascending, each drawn on its own with a chance proportional to its weight.

    weights: (M,), not negative, with a positive sum. M uniform numbers in order of size are sums of
    exponential ones over their total (Devroye, Non-Uniform Random Variate Generation, V.3.1), so nothing
    is sorted.
    """
    steps = rng.standard_exponential(len(weights) + 1)
    heights = np.cumsum(steps)
    return _under(weights, heights[:-1] / heights[-1])


def systematic(weights: Array, rng: Rng) -> Indices:
    """Returns M indices (M,), ascending, by one comb of M teeth that is put down at random.

    Each particle is drawn M w times, rounded down or up (Kitagawa 1996, appendix). weights: (M,), not
    negative, with a positive sum.
    """
    count = len(weights)
    return _under(weights, (np.arange(count) + rng.random()) / count)


def _under(weights: Array, heights: Array) -> Indices:
    """Returns the particles at ascending heights in [0, 1) of the pile of weights."""
    pile = np.cumsum(weights)
    last = np.flatnonzero(weights)[-1]  # where heights · sum rounds up to the sum, the last that weighs
    under: Indices = np.minimum(np.searchsorted(pile, heights * pile[-1], side="right"), last)
    return under


def effective_sample_size(weights: Array) -> float:
    """Returns (Σw)²/Σw² of weights (M,): M where all are equal, 1 where one has everything."""
    return float(weights.sum() ** 2 / (weights @ weights))


RESAMPLERS: dict[str, Callable[[Array, Rng], Indices]] = {
    "multinomial": multinomial,
    "systematic": systematic,
}
