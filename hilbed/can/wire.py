"""A CAN 2.0 A/B medium in simulated time: exact frame lengths, arbitration, errors, latency, load.

Event driven: nothing happens between the ends of frames. A frame starts when the bus has been idle for
the interframe space and, of all frames offered by then, it has the lowest identifier. Starts are not
rounded to bit boundaries. As long as nothing is wrong no bit is looked at; where something is (two nodes
with one identifier, a disturbed bit, a node that is alone or has made errors) see `contests`.
"""

from __future__ import annotations

from collections.abc import Callable
from heapq import heappop, heappush

from hilbed.can.contests import Contests, Flight, unnoticed
from hilbed.can.frame_length import INTERFRAME_BITS
from hilbed.can.statistics import Statistics
from hilbed.clock import NEVER, SECOND
from hilbed.types import NO_ERROR, BusError, Nanos, Transfer

_EXTENDED = 1 << 29  # stands for every extended identifier where it is looked up who hears

# Named tuples past their own __new__, which takes half of the time that a frame would cost otherwise.
_new = tuple.__new__


class Wire(Contests):
    """The medium between ports; `advance` runs it.

    bitrate: bit/s, a bit must last whole nanoseconds (else BusError). on_transfer: told every frame and
    every error frame at its end; on_state: told the time, a node's name and its state (`error_state`) when
    that changes. Time starts long ago, so that a bench may boot its drives before t = 0.

    A node that is alone is not acknowledged and tries for ever; where nobody witnesses it (no on_transfer),
    its attempts are left out once it is error passive, as nothing changes by them.
    """

    def __init__(
        self,
        bitrate: int,
        on_transfer: Callable[[Transfer], None] | None = None,
        on_state: Callable[[Nanos, str, str], None] = unnoticed,
    ) -> None:
        if bitrate <= 0 or SECOND % bitrate:
            raise BusError(f"bit rate {bitrate}: a bit must last a whole number of nanoseconds")
        super().__init__(SECOND // bitrate, on_transfer, on_state)
        self.bitrate = bitrate
        self._busy: Nanos = 0

    def advance(self, until: Nanos) -> None:
        """Runs everything that completes by `until`."""
        if until >= self._due:
            while self._posted:
                self._posted.popleft()()
            while self.step(until):
                pass
        elif until > self.now:  # most of the time nothing is under way
            self.now = until

    def step(self, until: Nanos) -> bool:
        """Runs to the end of the next frame, at most to `until`; returns whether a frame has ended."""
        flight = self._flight or self._arbitrate(until)
        if flight is None or flight[0] > until:
            self._rest(until)
            return False
        end, transfer, item, trial = flight
        self._flight = None
        self.now = end
        self._busy += self._free - transfer.start
        if trial is not None:
            self._settle(transfer, trial)
            return True
        self._frames += 1
        if self._on_transfer is not None:
            self._on_transfer(transfer)
        frame, sender = item[3], item[5]
        address = sender.number << 30 | (_EXTENDED if frame.extended else frame.id)
        hearers = self._hearers.get(address)
        if hearers is None:
            hearers = self._hearers[address] = self._find(sender, frame)
        for deliver in hearers:
            deliver(end, frame)
        return True

    @property
    def pending(self) -> bool:
        """Whether frames are queued or on the bus."""
        return bool(self._ready or self._waiting or self._posted or self._flight)

    @property
    def silent(self) -> bool:
        """Whether nothing will ever end on it unless somebody joins or sends.

        Nothing is queued, or only by a node that is alone.
        """
        if self._flight is not None or self._waiting or self._posted:
            return False
        if not self._ready:
            return True
        return self._on_transfer is None and self._trouble.alone([self._ready[0][5]])

    @property
    def due(self) -> Nanos:
        """Before when nothing can end."""
        return self._due

    def statistics(self) -> Statistics:
        """Returns the totals up to now."""
        return Statistics(self.now, self._frames, self._busy, self._worst, self._errors)

    def _arbitrate(self, until: Nanos) -> Flight | None:
        """Starts the next frame, if one can start before `until`: a rival may still be queued at `until`."""
        ready, waiting, start = self._ready, self._waiting, self._free
        if ready:  # queued while the bus was taken, or just now
            if self.now > start:
                start = self.now
        elif waiting:
            start = max(start, waiting[0][0])
        else:
            return None
        if start >= until:
            return None
        while waiting and waiting[0][0] <= start:
            heappush(ready, heappop(waiting)[1])
        if self._odd:
            return self._contest(start, until)
        item = heappop(ready)
        _, _, queued, frame, bits, sender = item
        bit = self._bit
        end = start + bits * bit
        self._free = end + INTERFRAME_BITS * bit
        if start - queued > self._worst:
            self._worst = start - queued
        transfer = _new(Transfer, (queued, start, end, frame, sender.name, NO_ERROR))
        self._flight = flight = (end, transfer, item, None)
        return flight

    def _rest(self, until: Nanos) -> None:
        """Moves time on to `until`, by when nothing has ended, and tells when something may."""
        recovering = self._odd and self._trouble.recovering
        if recovering and self._flight is None:
            self._welcome(until)
        if until > self.now:
            self.now = until
        if self._flight is not None:
            self._due = self._flight[0]
        elif self._ready or recovering or self._posted:
            self._due = until
        else:
            self._due = self._waiting[0][0] if self._waiting else NEVER
