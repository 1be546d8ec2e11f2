"""Differences: from when on, how large, and what counts as the same."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed.replay.differences import Difference, differences

T = np.arange(5) * 0.01


def _signals(**columns: np.ndarray) -> dict[str, np.ndarray]:
    return {"t": T, **columns}


def test_the_same_is_no_difference_unknown_included() -> None:
    column = np.array([np.nan, 1, 2, 3, -0.0])
    assert differences(_signals(a=column), _signals(a=column.copy())) == []


@given(st.integers(0, 4), st.integers(0, 4), st.floats(0.1, 10), st.floats(0.1, 10))
def test_first_and_largest(one: int, other: int, small: float, more: float) -> None:
    was = np.zeros(5)
    now = was.copy()
    now[one] += small
    now[other] -= small + more
    (found,) = differences(_signals(a=was), _signals(a=now))
    assert found.first == T[min(one, other)]
    assert found.largest == pytest.approx(np.max(np.abs(now)))
    assert found.at == T[int(np.argmax(np.abs(now)))]


def test_a_single_bit_counts() -> None:
    was = np.ones(5)
    now = was.copy()
    now[3] = np.nextafter(1.0, 2.0)
    (found,) = differences(_signals(a=was), _signals(a=now))
    assert found == Difference("a", T[3], 2.0**-52, T[3])


def test_a_turn_more_of_yaw_is_nothing_to_speak_of() -> None:
    was, now = np.zeros((5, 3)), np.zeros((5, 3))
    was[2, 2], now[2, 2] = np.pi, -np.pi + 1e-3
    (found,) = differences(_signals(estimate=was), _signals(estimate=now))
    assert found.largest == pytest.approx(1e-3)


def test_rows_and_numbers_that_one_side_lacks_differ_infinitely() -> None:
    was, now = np.zeros(5), np.zeros(5)
    now[4] = np.nan
    assert differences(_signals(a=was), _signals(a=now)) == [Difference("a", T[4], np.inf, T[4])]
    short = {"t": T[:3], "a": was[:3]}
    assert differences(_signals(a=was), short) == [Difference("a", T[3], np.inf, T[3])]
    assert differences(_signals(), _signals(a=was))[0].largest == np.inf


def test_innovations_of_a_moment_have_no_order() -> None:
    def nis(*values: float) -> dict[str, np.ndarray]:
        t, dof = np.array([0.1, 0.2, 0.2]), np.array([1, 1, 1])
        return _signals(
            **{"nis/t": t, "nis/value": np.array(values), "nis/dof": dof, "nis/accepted": dof > 0}
        )

    assert differences(nis(3.0, 1.0, 2.0), nis(3.0, 2.0, 1.0)) == []
    assert [found.column for found in differences(nis(3.0, 1.0, 2.0), nis(1.0, 3.0, 2.0))] == ["nis/value"]
