"""Seeds, values and the table of a sweep, without running anything."""

from __future__ import annotations

import json
from math import isnan
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed.sweep import Job, Line, Result, as_json_text, as_text, parse_seeds, split_values, tabulate
from hilbed.types import ScenarioError

numbers = st.floats(-1e6, 1e6)


def result(seed: int, criteria: dict[str, Any], metrics: dict[str, Any], status: int = 0) -> Result:
    verdict = {"criteria": criteria, "metrics": metrics, "reason": "" if status == 0 else "it went wrong"}
    return Result(Job("demo", ("a=1",), seed), status, verdict)


def criterion(value: float | None, bound: str = "max", passed: bool = True) -> dict[str, Any]:
    return {"value": value, "limit": 1.0, "bound": bound, "passed": passed}


def only(lines: list[Line], name: str) -> Line:
    (line,) = [line for line in lines if line.name == name]
    return line


@pytest.mark.parametrize(
    ("text", "seeds"), [("1..4", [1, 2, 3, 4]), ("0..0", [0]), ("7", [7]), ("08..10", [8, 9, 10])]
)
def test_seeds_include_both_ends(text: str, seeds: list[int]) -> None:
    assert list(parse_seeds(text)) == seeds


@pytest.mark.parametrize(
    "text", ["", "..", "1..", "..4", "4..1", "-1..3", "1-4", "1...4", "1..4..6", "1.5", "a..b", " 1", "1,2"]
)
def test_seeds_that_are_none_are_refused_with_what_was_given(text: str) -> None:
    with pytest.raises(ScenarioError, match="--seeds"):
        parse_seeds(text)


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("1,2", ["1", "2"]),
        ("0.5", ["0.5"]),
        ("[1, 2],[3, 4]", ["[1, 2]", "[3, 4]"]),
        ("{kind: ekf, gate: 3},odometry", ["{kind: ekf, gate: 3}", "odometry"]),
        ("[[1, 2], {a: [3, 4]}],x", ["[[1, 2], {a: [3, 4]}]", "x"]),
        ("", [""]),
        ("a,", ["a", ""]),
    ],
)
def test_values_are_split_outside_brackets(text: str, values: list[str]) -> None:
    assert split_values(text) == values


@given(st.lists(st.text("ab 1.:-_"), min_size=1))
def test_splitting_undoes_joining(values: list[str]) -> None:
    assert split_values(",".join(values)) == values


@given(st.lists(numbers, min_size=1, max_size=8), st.sampled_from(["max", "min"]))
def test_the_worst_seed_is_on_the_wrong_side_of_the_limit(values: list[float], bound: str) -> None:
    results = [result(seed, {"c": criterion(value, bound)}, {}) for seed, value in enumerate(values, 5)]
    (line,) = tabulate(results)
    worst = max(values) if bound == "max" else min(values)
    assert values[line.worst - 5] == worst
    assert (line.low, line.high) == (min(values), max(values))
    assert line.mean == pytest.approx(sum(values) / len(values))
    assert line.passed == len(values)


def test_a_run_without_the_number_is_the_worst_and_not_met() -> None:
    results = [
        result(1, {"c": criterion(0.9)}, {}),
        result(2, {"c": criterion(None, passed=False)}, {}, status=3),
        result(3, {"c": criterion(0.1)}, {}),
    ]
    line = only(tabulate(results), "c")
    assert (line.worst, line.passed) == (2, 2)
    assert (line.low, line.mean, line.high) == pytest.approx((0.1, 0.5, 0.9))


def test_a_criterion_that_no_run_could_measure_is_still_in_the_table() -> None:
    line = only(tabulate([result(4, {"c": criterion(None, passed=False)}, {}, status=3)]), "c")
    assert (line.worst, line.passed) == (4, 0)
    assert isnan(line.mean)


def test_metrics_come_after_the_criteria_by_name_over_the_runs_that_have_them() -> None:
    results = [
        result(1, {"z": criterion(1.0)}, {"b": 1.0, "a": 5.0, "never": None}),
        result(2, {"z": criterion(2.0)}, {"b": 3.0, "a": None, "never": None}),
    ]
    lines = tabulate(results)
    assert [line.name for line in lines] == ["z", "a", "b"]
    assert only(lines, "a")[1:] == (5.0, 5.0, 5.0, 1, None)
    assert only(lines, "b")[1:] == (2.0, 1.0, 3.0, 2, None)


def test_the_text_names_passes_the_worst_seed_and_why_a_run_broke() -> None:
    results = [
        result(1, {"c": criterion(0.25)}, {}),
        result(2, {"c": criterion(2.5, passed=False)}, {}, status=1),
        result(3, {"c": criterion(None, passed=False)}, {}, status=3),
    ]
    text = as_text({("a=1",): tabulate(results[:2])}, results)
    head, _, row, *rest = text.splitlines()
    assert head == "demo a=1: 1 of 3 passed"
    assert row.split()[:5] == ["c", "1.375", "0.25", "2.5", "2"]
    assert rest == ["  seed 3: it went wrong"]


def test_the_json_holds_every_run() -> None:
    results = [result(seed, {"c": criterion(0.5)}, {"m": 1.0}) for seed in (1, 2)]
    content = json.loads(as_json_text({("a=1",): tabulate(results)}, results))
    assert [run["seed"] for run in content["runs"]] == [1, 2]
    assert content["tables"][0]["set"] == ["a=1"]
    assert [line["name"] for line in content["tables"][0]["lines"]] == ["c", "m"]


def test_the_json_has_null_where_no_run_has_the_number() -> None:
    results = [result(4, {"c": criterion(None, passed=False)}, {}, status=3)]
    text = as_json_text({("a=1",): tabulate(results)}, results)
    assert "NaN" not in text
    assert json.loads(text)["tables"][0]["lines"][0]["mean"] is None
