"""The results as lines of text and as JSON."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

from hilbed import __version__
from hilbed.conformance.result import Result

_WIDTH = 46


def line(result: Result) -> str:
    """Returns one result as a line."""
    number = "" if result.measured is None else f"{result.measured:.4g} {result.unit}"
    if result.limit is not None:
        number += f" ≤ {result.limit:.4g}"
    words = "  ".join(part for part in (number, result.note) if part)
    return f"{result.status:13} {result.check:{_WIDTH}} {words}".rstrip()


def summary(results: Sequence[Result]) -> str:
    """Returns how many there were of each kind."""
    counts = Counter(result.status for result in results)
    return ", ".join(f"{counts[status]} {status}" for status in ("pass", "fail", "not supported", "not run"))


def passed(results: Sequence[Result]) -> bool:
    """Tells whether nothing has failed."""
    return all(result.status != "fail" for result in results)


def document(results: Sequence[Result], about: dict[str, Any]) -> dict[str, Any]:
    """Returns the report as JSON has it."""
    return {
        "hilbed": __version__,
        **about,
        "passed": passed(results),
        "summary": dict(Counter(result.status for result in results)),
        "checks": [result.as_dict() for result in results],
    }
