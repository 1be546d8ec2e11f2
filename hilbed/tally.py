"""What estimators and controllers count besides what they return, for verdict.json and the report."""

from __future__ import annotations

from typing import Protocol, runtime_checkable


@runtime_checkable
class Counting(Protocol):
    """A part that has something to say at the end of a run."""

    def counts(self) -> dict[str, float]:
        """Returns its counters, and other numbers, by name; NaN where there is none yet."""
        ...


def counts_of(part: object) -> dict[str, float]:
    """Returns what a part has counted; nothing where it does not count."""
    return part.counts() if isinstance(part, Counting) else {}
