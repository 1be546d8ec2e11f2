from __future__ import annotations

import io
import json
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from hilbed.cost import PARTS
from hilbed.criteria import CriterionSpec, judge
from hilbed.verdict import Account, coloured, conclude, table, text

T = np.arange(101) * 0.01
SIGNALS = {
    "t": T,
    "truth": np.zeros((101, 3)),
    "estimate": np.column_stack([np.where(T < 0.5, 1.0, 0.1), np.zeros((101, 2))]),
}


def account(reason: str = "") -> Account:
    return Account("demo", 7, reason, 1.0, 0.1, dict.fromkeys(PARTS, 0.01), "ab", "cd")


def concluded(reason: str = "", **criteria: CriterionSpec) -> dict[str, Any]:
    content = conclude(account(reason), SIGNALS, criteria)
    again: dict[str, Any] = json.loads(text(content))
    assert again == content
    return content


def criterion(**block: object) -> CriterionSpec:
    return CriterionSpec.model_validate(block)


def test_verdict_json_has_the_keys_of_the_contract() -> None:
    content = concluded(estimate_position_max=criterion(max=1.0))
    assert set(content) == {
        "scenario", "seed", "passed", "reason", "criteria", "metrics", "sim_time", "wall_time",
        "real_time_factor", "cost", "cost_beside", "hash", "signals_hash", "events",
    }  # fmt: skip
    assert content["passed"] is True
    assert content["reason"] == ""
    assert content["real_time_factor"] == pytest.approx(10.0)
    assert set(content["cost"]) == set(PARTS)
    entry = content["criteria"]["estimate_position_max"]
    assert entry == {"value": 1.0, "limit": 1.0, "passed": True, "bound": "max"}
    assert content["metrics"]["estimate_position_max"] == 1.0


def test_limits_hold_in_their_window() -> None:
    block = {"metric": "estimate_position_max"}
    content = concluded(
        whole=criterion(**block, max=0.5),
        late=criterion(**block, max=0.5, **{"from": 0.5}),
        early=criterion(**block, min=0.5, to=0.4),
        low=criterion(**block, min=2.0),
    )
    passed = {name: entry["passed"] for name, entry in content["criteria"].items()}
    assert passed == {"whole": False, "late": True, "early": True, "low": False}
    assert content["reason"] == "whole: 1 is above 0.5; low: 1 is below 2"


def test_the_window_of_a_limit_is_told() -> None:
    block = {"metric": "estimate_position_max", "max": 5.0}
    content = concluded(
        whole=criterion(**block),
        late=criterion(**block, **{"from": 0.5}),
        early=criterion(**block, to=0.4),
        amid=criterion(**block, **{"from": 0.2, "to": 0.4}),
    )
    windows = [(entry.get("from"), entry.get("to")) for entry in content["criteria"].values()]
    assert windows == [(None, None), (0.5, None), (None, 0.4), (0.2, 0.4)]
    lines = [line.split("≤ 5")[1].split("pass")[0].strip() for line in table(content).splitlines()[:4]]
    assert lines == ["", "from 0.5 s", "to 0.4 s", "0.2–0.4 s"]


def test_a_number_that_is_not_there_fails_with_its_reason() -> None:
    content = concluded(nees_mean=criterion(max=3.0), reference_distance_rms=criterion(max=3.0))
    entry = content["criteria"]["nees_mean"]
    assert (entry["value"], entry["passed"]) == (None, False)
    assert "covariance" in entry["reason"]
    assert "the run has no reference" in content["reason"]


def test_an_aborted_run_does_not_pass_whatever_its_numbers() -> None:
    content = concluded("diverged at t = 1.0 s", estimate_position_max=criterion(max=2.0))
    assert content["criteria"]["estimate_position_max"]["passed"] is True
    assert content["passed"] is False
    assert content["reason"] == "diverged at t = 1.0 s"


def test_a_run_that_never_began_has_a_verdict() -> None:
    empty = {name: column[:0] for name, column in SIGNALS.items()}
    nothing = account("node left is missing")._replace(sim_time=0.0, wall_time=0.0)
    content = conclude(nothing, empty, {"estimate_position_rms": criterion(max=1.0)})
    assert json.loads(text(content))["metrics"]["estimate_position_rms"] is None
    assert content["real_time_factor"] is None
    assert "node left is missing" in table(content)


@pytest.mark.parametrize(
    "block",
    [
        {},
        {"max": 1.0, "min": 0.0},
        {"max": float("nan")},
        {"max": 1.0, "from": 2.0, "to": 1.0},
        {"max": 1.0, "from": -1.0},
        {"maximum": 1.0},
    ],
)
def test_a_criterion_that_cannot_be_judged_is_refused(block: dict[str, object]) -> None:
    with pytest.raises(ValidationError):
        criterion(**block)


def test_a_criterion_writes_what_it_reads() -> None:
    block = {"metric": "load_dip", "drive": "left", "max": 0.25, "from": 10.0, "to": 15.0}
    dumped = criterion(**block).model_dump(by_alias=True, exclude_none=True)
    assert dumped == block


def test_the_table_shows_every_criterion_and_is_coloured_only_on_request() -> None:
    content = concluded(estimate_position_max=criterion(max=0.5), estimate_position_final=criterion(max=0.5))
    plain = table(content)
    lines = plain.splitlines()
    assert lines[0].split() == ["estimate_position_max", "1", "≤", "0.5", "FAIL"]
    assert lines[1].split() == ["estimate_position_final", "0.1", "≤", "0.5", "pass"]
    assert "demo seed 7: FAILED" in plain
    assert "\x1b" not in plain
    assert "\x1b[31mFAIL\x1b[0m" in table(content, colour=True)


def test_no_color_is_honoured(monkeypatch: pytest.MonkeyPatch) -> None:
    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    monkeypatch.delenv("NO_COLOR", raising=False)
    assert coloured(Terminal())
    assert not coloured(io.StringIO())
    monkeypatch.setenv("NO_COLOR", "1")
    assert not coloured(Terminal())


def test_a_window_after_the_end_is_told() -> None:
    block = {"metric": "estimate_position_rms", "max": 1.0, "from": 1e6, "to": 2e6}
    late = CriterionSpec.model_validate(block)
    (judged,) = judge(SIGNALS, {"late": late}).values()
    assert not judged.passed
    assert judged.reason == "the run has no rows from 1e+06 s to 2e+06 s"
    (judged,) = judge(SIGNALS, {"late": late.model_copy(update={"end": None})}).values()
    assert judged.reason == "the run has no rows from 1e+06 s on"


def test_the_table_tells_what_was_counted_but_not_that_nothing_was() -> None:
    counts = {"estimator": {"ignored": 3, "recovered": 0, "effective": None}, "controller": {"beyond": 0}}
    content = conclude(account()._replace(parts={"counts": counts}), SIGNALS, {})
    assert content["counts"] == counts
    assert "estimator: ignored 3" in table(content).splitlines()
    assert "controller" not in table(content)
    nothing = {"estimator": {"ignored": 0}, "controller": {}}
    plain = conclude(account()._replace(parts={"counts": nothing}), SIGNALS, {})
    assert table(plain) == table(concluded())
