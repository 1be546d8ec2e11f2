"""Criteria over the signals of a run."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf, isfinite, nan
from typing import NamedTuple

from hilbed.criteria.metrics import measure
from hilbed.criteria.signals import Column, Missing, window
from hilbed.criteria.spec import CriterionSpec, metric_of


class Judged(NamedTuple):
    """How a criterion went; bound is "max" or "min", reason is empty where it passed.

    start, end: s, the window that it was judged over; None: to the end of the run.
    """

    value: float
    limit: float
    bound: str
    passed: bool
    reason: str
    start: float = 0.0
    end: float | None = None


def judge(signals: Mapping[str, Column], criteria: Mapping[str, CriterionSpec]) -> dict[str, Judged]:
    """Judges every criterion; a number that is missing or not finite fails, with its reason."""
    return {
        name: _judge(signals, name, criterion)._replace(start=criterion.start, end=criterion.end)
        for name, criterion in criteria.items()
    }


def _judge(signals: Mapping[str, Column], name: str, criterion: CriterionSpec) -> Judged:
    upper, lower = criterion.max, criterion.min
    bound, limit = ("max", upper) if upper is not None else ("min", lower)
    assert limit is not None, "a criterion has one of the two"
    value, reason = _measured(signals, name, criterion)
    if reason:
        return Judged(value, limit, bound, False, reason)
    if not isfinite(value):
        return Judged(value, limit, bound, False, f"{value} is no number to judge")
    if value > limit if bound == "max" else value < limit:
        word = "above" if bound == "max" else "below"
        return Judged(value, limit, bound, False, f"{value:.4g} is {word} {limit:.4g}")
    return Judged(value, limit, bound, True, "")


def _measured(
    signals: Mapping[str, Column], name: str, criterion: CriterionSpec
) -> tuple[float, str]:  # fmt: skip
    end = inf if criterion.end is None else criterion.end
    try:
        chosen = window(signals, criterion.start, end)
        if not any(len(chosen[time]) for time in ("t", "tick/t") if time in chosen):
            last = "on" if end == inf else f"to {end:g} s"
            raise Missing(f"the run has no rows from {criterion.start:g} s {last}")
        least = criterion.min is not None
        return measure(chosen, metric_of(name, criterion), criterion.drive, least), ""
    except Missing as missing:
        return nan, str(missing)
