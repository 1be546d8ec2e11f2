"""One criterion of a scenario: a metric of the finished run and the limit that it must keep."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import Field, model_validator

from hilbed.spec import Finite, NonNegative, Spec


class CriterionSpec(Spec):
    """A limit on a metric, over the whole run or a window of it.

    metric: its name where the criterion has another one; drive: for a drive's metric, else the worst of all;
    exactly one of max and min, in the metric's unit; from, to: s.
    """

    metric: str | None = None
    drive: str | None = None
    max: Finite | None = None
    min: Finite | None = None
    start: Annotated[NonNegative, Field(alias="from")] = 0.0
    end: Annotated[NonNegative | None, Field(alias="to")] = None

    @model_validator(mode="after")
    def _holds(self) -> Self:
        if (self.max is None) == (self.min is None):
            raise ValueError("needs exactly one of max and min")
        if self.end is not None and self.end <= self.start:
            raise ValueError(f"the window from {self.start:g} s to {self.end:g} s is empty")
        return self


def metric_of(name: str, criterion: CriterionSpec) -> str:
    """Returns the metric that a criterion means: its own or the one that it is called after."""
    return criterion.metric or name
