"""Something that must keep coming: SYNC, another node's heartbeat."""

from __future__ import annotations

NEVER = 1 << 62
MILLISECOND = 1_000_000


class Watchdog:
    """Watches from the first kick on; a period of 0 ms never expires.

    due: when it expires unless kicked before (ns).
    """

    __slots__ = ("_period", "due")

    def __init__(self, period_ms: int) -> None:
        self._period = period_ms * MILLISECOND
        self.due = NEVER

    def kick(self, t: int) -> None:
        if self._period:
            self.due = t + self._period

    def disarm(self) -> None:
        self.due = NEVER

    def poll(self, t: int) -> bool:
        """Tells once that it has expired; the next kick arms it again."""
        if t < self.due:
            return False
        self.due = NEVER
        return True
