"""Frames that wait for a wire: those that are offered to it and those queued ahead of time."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from heapq import heapify, heappush

from hilbed.can.arbitration import arbitration
from hilbed.can.frame_length import frame_bits
from hilbed.can.port import Port, Queued
from hilbed.can.trouble import Tamper
from hilbed.clock import NEVER
from hilbed.types import Frame, Nanos

LONG_AGO: Nanos = -(1 << 62)
_MANY = 1 << 16  # identifiers whose senders are remembered


class Queues:
    """What all nodes of a wire have queued; `queue` takes a port's frame at a time, or now if that is past.

    now: the wire's time. It is remembered who sends an identifier: as long as nobody shares one, the lowest
    of all frames wins the bus without more ado.
    """

    def __init__(self) -> None:
        self.now = LONG_AGO
        self.queue: Callable[[Nanos, Frame, Port], None] = self._queue
        self._ready: list[Queued] = []
        self._waiting: list[tuple[Nanos, Queued]] = []  # queued ahead of time
        self._posted: deque[Callable[[], object]] = deque()
        self._due: Nanos = NEVER  # nothing can end before
        self._order = 0
        self._owners: dict[int, Port | None] = {}  # who sends, by arbitration; None: several
        self._shared = False  # several nodes send one identifier
        self._odd = True  # something may not go smoothly
        self._tamper: Tamper | None = None

    def later(self, act: Callable[[], object]) -> None:
        """Has something done at the next `advance`; may be called from any thread."""
        self._posted.append(act)
        self._due = LONG_AGO

    def withdraw(self, port: Port, frame: Frame | None = None) -> int:
        """Takes back what a node has queued, but for what is on the bus; returns how much that was.

        frame: only this very one, not others that are equal.
        """

        def stays(item: Queued) -> bool:
            return item[5] is not port or not (frame is None or item[3] is frame)

        before = len(self._ready) + len(self._waiting)
        self._ready = [item for item in self._ready if stays(item)]
        self._waiting = [entry for entry in self._waiting if stays(entry[1])]
        heapify(self._ready)
        heapify(self._waiting)
        return before - len(self._ready) - len(self._waiting)

    def waiting(self, port: Port) -> int:
        """Returns how many frames of a node wait for the bus."""
        return sum(item[5] is port for item in self._ready)

    def _queue(self, t: Nanos, frame: Frame, sender: Port) -> None:
        """Queues a frame of `sender` at `t`, or now if `t` is past."""
        bits = frame_bits(frame)
        if sender.guarded and not sender.admits(t, frame):
            return
        identifier, _, extended, remote = frame
        key = arbitration(identifier, extended, remote)
        self._order = order = self._order + 1
        if self._owners.get(key) is not sender:
            self._share(key, sender)
        now = self.now
        if t > now:
            heappush(self._waiting, (t, (key, order, t, frame, bits, sender)))
        else:
            heappush(self._ready, (key, order, now, frame, bits, sender))
        if t < self._due:
            self._due = t

    def _queue_tampered(self, t: Nanos, frame: Frame, sender: Port) -> None:
        frame_bits(frame)  # what is no frame is refused, whatever may happen to it
        assert self._tamper is not None
        for when in self._tamper.queued(max(t, self.now), frame, sender.name):
            self._queue(when, frame, sender)

    def _share(self, key: int, sender: Port) -> None:
        """Notes who sends an identifier, and that something may go wrong if more than one node does."""
        if len(self._owners) > _MANY:  # only those that wait matter
            self._owners = {item[0]: item[5] for item in (*self._ready, *(one[1] for one in self._waiting))}
        if self._owners.setdefault(key, sender) is not sender:
            self._owners[key] = None
            self._shared = self._odd = True
