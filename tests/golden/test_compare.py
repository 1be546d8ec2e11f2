"""A golden record notices what it is there to notice, and says where."""

from __future__ import annotations

from copy import deepcopy
from math import pi
from typing import Any

import pytest

from tests.golden.compare import moved

GOLDEN: dict[str, Any] = {
    "settings": ["duration=1"],
    "times": [0.0, 0.5, 1.0],
    "signals": {"truth/x": [0.0, 2.0, 4.0], "truth/yaw": [0.0, 3.0, pi], "speed": [None, 0.0, 1e-9]},
    "numbers": {"count": 17.0, "final": None},
}


def changed(block: str, name: str, value: Any) -> dict[str, Any]:
    new = deepcopy(GOLDEN)
    new[block][name] = value
    return new


def test_nothing_moves_by_itself() -> None:
    assert moved(GOLDEN, deepcopy(GOLDEN)) == []


@pytest.mark.parametrize("off", [3.9e-6, -3.9e-6])
def test_a_millionth_of_the_largest_value_is_let_pass(off: float) -> None:
    assert moved(GOLDEN, changed("signals", "truth/x", [off, 2.0 + off, 4.0 - off])) == []


def test_more_is_told_with_its_size_and_times() -> None:
    (change,) = moved(GOLDEN, changed("signals", "truth/x", [0.0, 2.1, 4.5]))
    assert change.name == "truth/x"
    assert (change.first, change.worst) == (0.5, 1.0)
    assert (change.largest, change.limit) == pytest.approx((0.5, 4e-6))
    assert str(change) == "truth/x: 0.5 off, allowed 4e-06; from t = 0.5 s, most at 1 s"


def test_a_yaw_may_be_written_on_either_side_of_half_a_turn() -> None:
    assert moved(GOLDEN, changed("signals", "truth/yaw", [0.0, 3.0, -pi])) == []
    assert len(moved(GOLDEN, changed("signals", "truth/yaw", [0.0, 3.0, -pi + 0.01]))) == 1


def test_round_off_of_what_is_nearly_zero_is_let_pass() -> None:
    assert moved(GOLDEN, changed("signals", "speed", [None, 0.0, 1.5e-9])) == []
    assert len(moved(GOLDEN, changed("signals", "speed", [None, 0.0, 2.5e-9]))) == 1


@pytest.mark.parametrize(
    ("block", "name", "value"),
    [
        ("signals", "speed", [0.0, 0.0, 1e-9]),
        ("signals", "speed", [None, 0.0]),
        ("signals", "another", [0.0, 0.0, 0.0]),
        ("numbers", "count", 18.0),
        ("numbers", "count", None),
        ("numbers", "final", 0.0),
    ],
)
def test_what_appears_vanishes_or_counts_differently_has_moved(block: str, name: str, value: Any) -> None:
    (change,) = moved(GOLDEN, changed(block, name, value))
    assert change.name == name


def test_what_is_gone_and_other_settings_have_moved() -> None:
    new = deepcopy(GOLDEN)
    del new["signals"]["speed"]
    new["settings"] = ["duration=2"]
    assert [change.name for change in moved(GOLDEN, new)] == ["settings", "speed"]
