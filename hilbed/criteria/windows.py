"""A criterion's window in words, for verdicts, reports and pages."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def window_text(entry: Mapping[str, Any]) -> str:
    """Returns the window of a criterion's entry in verdict.json; empty where it is the whole run."""
    start, end = entry.get("from"), entry.get("to")
    if start is None:
        return "" if end is None else f"to {end:g} s"
    return f"from {start:g} s" if end is None else f"{start:g}–{end:g} s"
