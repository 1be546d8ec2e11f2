"""Time on the bench is integer nanoseconds since the start of the run."""

from __future__ import annotations

from hilbed.types import Nanos

SECOND: Nanos = 1_000_000_000
MILLISECOND: Nanos = 1_000_000
NEVER: Nanos = 1 << 62
"""Later than anything."""


def nanos(seconds: float) -> Nanos:
    """Converts seconds to the nearest nanosecond."""
    return round(seconds * SECOND)


def seconds(t: Nanos) -> float:
    """Converts nanoseconds to seconds."""
    return t / SECOND
