"""Numbers beside numbers."""

from __future__ import annotations

import re
from math import pi
from pathlib import Path

import numpy as np
import pytest

from hilbed.criteria import Signals
from hilbed.paper import tables
from hilbed.paper.catalogue import Claim, Table
from hilbed.paper.runs import Done
from hilbed.report.run import Run
from hilbed.types import Pose


def run(metric: float | None = 2.0, rows: int = 3, passed: bool = True) -> Run:
    entry = {"value": metric, "limit": 2.5, "passed": passed, "bound": "max"}
    verdict = {"metrics": {"nees_mean": metric}, "cost": {"estimator": 0.3}, "criteria": {"nees": entry}}
    signals = Signals(t=np.arange(rows), truth=np.tile((1.0, 2.0, 3.0), (rows, 1)))
    return Run(Path(), "", verdict, signals, (), (), ())


def words(text: str | None) -> list[str]:
    return [word.strip() for word in re.split(r"<[^>]*>", text or "") if word.strip()]


def claim(ours: str = "nees_mean", law: str = "") -> Claim:
    return Claim(what="w", printed="3", law=law, scenario="a", ours=ours)


def test_statistics_wrap_the_yaw_and_take_the_sample_standard_deviation() -> None:
    poses = [Pose(1.0, 2.0, pi - 0.1), Pose(1.2, 2.4, -pi + 0.1)]
    table = Table(scenarios=["demo"], seeds=(0, 1), mean=(1.0, 2.0, pi), std=(0.1, 0.1, 0.1))
    numbers = [float(word) for word in words(tables.statistics(table, poses)) if "." in word]
    stds = np.std([(1.0, 2.0, -0.1), (1.2, 2.4, 0.1)], axis=0, ddof=1)
    expected = [1.0, 1.1, 0.1, stds[0], 2.0, 2.2, 0.1, stds[1], pi, pi, 0.1, stds[2]]
    assert numbers == pytest.approx(expected, abs=1e-4)
    assert tables.statistics(table, poses[:1]) is None


@pytest.mark.parametrize(
    ("ours", "shown"), [("nees_mean", "2"), ("final", "1.000, 2.000, 3.000"), ("cost/estimator", "100.000")]
)
def test_a_claim_shows_a_metric_a_pose_or_a_cost(ours: str, shown: str) -> None:
    assert words(tables.claims([claim(ours)], {"a": run()})) == ["printed", "ours", "w", "3", shown]


def test_twins_and_closed_forms_have_columns_where_there_are_any() -> None:
    both = {"a": run(), "a-bench": run(4.0)}
    head = ["printed", "closed form", "ours", "bench"]
    assert words(tables.claims([claim(law="1.9")], both)) == [*head, "w", "3", "1.9", "2", "4"]
    assert tables.claims([], both) is None


def test_what_is_not_known_is_a_dash() -> None:
    assert tables.value(claim(), {}, "") == "–"
    assert tables.value(claim(), {"a": run(None)}, "") == "–"
    assert tables.value(claim("final"), {"a": run(rows=0)}, "") == "–"


def test_criteria_of_a_twin_stand_beside_the_ideal_ones() -> None:
    text = tables.criteria(["a", "b"], {"a": run(), "a-bench": run(4.0, passed=False), "c": run()})
    assert words(text) == ["ours", "limit", "bench", "limit", "a", "nees", "2", "≤ 2.5", "4", "≤ 2.5"]
    assert text is not None
    assert re.findall(r'number (met|unmet)"', text) == ["met", "unmet"]
    assert "bench" not in words(tables.criteria(["a"], {"a": run(None)}))
    assert "none" in words(tables.criteria(["a"], {"a": run(None)}))
    assert tables.criteria(["b"], {"a": run()}) is None


def test_the_window_of_a_limit_stands_beside_it() -> None:
    late = run()
    late.verdict["criteria"]["nees"]["from"] = 2.0
    assert words(tables.criteria(["a"], {"a": late})) == ["ours", "limit", "a", "nees", "2", "≤ 2.5 from 2 s"]


def test_the_overview_tells_what_passed_what_failed_and_what_was_not_run() -> None:
    folders = {"p/a": "a", "p/a-bench": "a-bench", "p/b": "b", "p/a@1": "1", "p/a@2": "2"}
    done = {"p/a": Done(0), "p/a-bench": Done(3, "broken"), "p/a@1": Done(0)}
    text = tables.overview(folders, done)
    assert words(text) == [
        *("as in the paper", "bench twin", "values varied"),
        *("a", "passed", "·", "report", "failed", "·", "report", "1 of 2 passed"),
        *("b", "not run"),
    ]
    assert re.findall('href="([^"]*)"', text) == ["a/report.html", "a-bench/report.html"]
