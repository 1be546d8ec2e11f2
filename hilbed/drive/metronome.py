"""How many ticks are due: absolute deadlines, small bursts when late, time dropped after a long stall."""

from __future__ import annotations

from hilbed.types import Nanos

BURST = 5
"""As many ticks are made up for at a time, so that frames are looked at and sent in between."""
STALL: Nanos = 100_000_000
"""Who is later than this has not been late but away: the ticks are not made up for."""


class Metronome:
    """Ticks of a fixed period from a start on; times are those of one steady clock, in ns.

    ticks: number of the next one, so that its time is ticks × period, dropped ones included; worst: the
    latest that a tick was; dropped: ticks that never were.
    """

    def __init__(self, start: Nanos, period: Nanos) -> None:
        self._start = start
        self._period = period
        self.ticks = 0
        self.dropped = 0
        self.worst: Nanos = 0

    @property
    def deadline(self) -> Nanos:
        """When the next tick is due."""
        return self._start + self.ticks * self._period

    def due(self, now: Nanos) -> int:
        """Returns how many ticks to run now, at most a burst; `ran` has to be told of each."""
        late = now - self.deadline
        if late < 0:
            return 0
        if late > STALL:
            away = late // self._period
            self.dropped += away
            self.ticks += away
            return 1
        self.worst = max(self.worst, late)
        return min(late // self._period + 1, BURST)

    def ran(self) -> None:
        """Notes that a tick has run."""
        self.ticks += 1
