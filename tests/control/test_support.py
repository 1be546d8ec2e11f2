"""The exact selection beside brute force over all pairs."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from hilbed.control.support import most_supported
from hilbed.control.support_grid import Grid
from hilbed.types import Array


def support(x: Array, y: Array) -> Array:
    dx, dy = x[:, None] - x, y[:, None] - y
    return np.asarray(np.count_nonzero(dx * dx + dy * dy < 1, axis=1), dtype=float)


def brute(x: Array, y: Array) -> int:
    return int(np.argmax(support(x, y)))  # the first of the largest


def blob(rng: np.random.Generator, count: int, scale: float) -> Array:
    return rng.normal(size=(2, count)) * scale


def stripe(rng: np.random.Generator, count: int, scale: float) -> Array:
    return rng.uniform(-1, 1, size=(2, count)) * [[scale], [0.03]]


def lattice(rng: np.random.Generator, count: int, scale: float) -> Array:
    """Multiples of 1/8 and of (0.6, 0.8): many pairs exactly one unit apart, many ties."""
    steps = rng.integers(-12, 12, size=(2, count)) * max(round(scale), 1)
    return steps / 8 if count % 2 else steps * np.array([[0.6], [0.8]])


def ring(rng: np.random.Generator, count: int, scale: float) -> Array:
    angle = rng.uniform(0, 7, count)
    return scale * np.array((np.cos(angle), np.sin(angle)))


def copies(rng: np.random.Generator, count: int, scale: float) -> Array:
    return blob(rng, max(count // 20, 1), scale).repeat(20, axis=1)


def strays(rng: np.random.Generator, count: int, scale: float) -> Array:
    points = blob(rng, count, 0.4)
    points[:, :3] *= 10 * scale
    return points


def far_apart(rng: np.random.Generator, count: int, scale: float) -> Array:
    return np.where(rng.random((2, count)) < 0.02, 1e6, 1.0) * blob(rng, count, scale)


MakeCloud = Callable[[np.random.Generator, int, float], Array]
CLOUDS: list[MakeCloud] = [blob, stripe, lattice, ring, copies, strays, far_apart]


@settings(max_examples=300)
@given(
    st.sampled_from(CLOUDS),
    st.integers(0, 2**32 - 1),
    st.integers(1, 1200),
    st.sampled_from([0.01, 0.3, 0.6, 1.0, 2.0, 10.0, 100.0]),
)
def test_same_index_as_brute_force(cloud: MakeCloud, seed: int, count: int, scale: float) -> None:
    x, y = cloud(np.random.default_rng(seed), count, scale)
    assert most_supported(x, y) == brute(x, y)


near = st.one_of(st.floats(-3, 3), st.sampled_from([0.0, 1.0, -1.0, 0.6, 0.8, np.nextafter(1, 0), 5e-324]))


@settings(max_examples=300)
@given(st.lists(st.tuples(near, near), min_size=1, max_size=40))
@example([(0.0, 0.0), (1.0, 0.0), (1.0, 0.0)])
def test_same_index_as_brute_force_where_pairs_are_just_one_unit_apart(
    points: list[tuple[float, float]],
) -> None:
    x, y = np.array(points).T
    assert most_supported(x, y) == brute(x, y)


@pytest.mark.parametrize("cloud", CLOUDS[:-1])  # the last would need too large a grid
@pytest.mark.parametrize("n", [0.25, 1.0, 2.0, 8.0, 32.0])
def test_bounds_hold_and_counts_are_exact_at_any_side(cloud: MakeCloud, n: float) -> None:
    x, y = cloud(np.random.default_rng(3), 401, 2.0)
    grid, everyone = Grid(x, y, n), np.arange(len(x))
    assert (grid.at_most(everyone) >= support(x, y)).all()
    np.testing.assert_array_equal(grid.exactly(everyone), support(x, y))


def test_itself_is_included_the_edge_is_not_and_ties_go_to_the_lowest_index() -> None:
    x = np.array([0.0, 5.0, 6.0, 7.0, 6.5])
    np.testing.assert_array_equal(support(x, 0 * x), [1, 1, 2, 2, 3])
    assert most_supported(x, 0 * x) == 4
    assert most_supported(x[:4], 0 * x[:4]) == 0


def test_a_large_cloud_of_many_levels() -> None:
    x, y = stripe(np.random.default_rng(1), 20_000, 5.0)
    order = np.argsort(x)
    counts = []
    for k in range(len(x)):  # only those whose x is near enough
        low, high = np.searchsorted(x[order], (x[k] - 1.01, x[k] + 1.01))
        some = order[low:high]
        dx, dy = x[k] - x[some], y[k] - y[some]
        counts.append(np.count_nonzero(dx * dx + dy * dy < 1))
    assert most_supported(x, y) == int(np.argmax(counts))


@pytest.mark.filterwarnings("ignore:overflow")
@pytest.mark.parametrize("bad", [[], [np.nan, 0.0], [np.inf, 0.0], [1e308, -1e308]])
def test_what_has_no_support_is_refused(bad: list[float]) -> None:
    with pytest.raises(ValueError, match="support needs"):
        most_supported(np.array(bad), np.zeros(len(bad)))
