"""A CAN 2.0 A/B medium in simulated time: exact frame lengths, arbitration, latency, load.

Event driven: nothing happens between the ends of frames. A frame starts when the bus has been idle for
the interframe space and, of all frames queued by then, it has the lowest identifier. Starts are not
rounded to bit boundaries. No errors yet: two nodes that send the same identifier at once (an error on a
real bus) are served in the order of queueing.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from heapq import heappop, heappush
from typing import TypeAlias

from hilbed.can.arbitration import arbitration
from hilbed.can.frame_length import INTERFRAME_BITS, frame_bits
from hilbed.can.statistics import Statistics
from hilbed.clock import SECOND
from hilbed.types import BusError, Frame, Nanos, Received, Transfer

Listener = Callable[[Nanos, Frame], None]

_LONG_AGO: Nanos = -(1 << 62)
_NEVER: Nanos = 1 << 62
_EXTENDED = 1 << 29  # stands for every extended identifier where it is looked up who hears


_Queued: TypeAlias = "tuple[int, int, Nanos, Frame, int, Port]"
"""A frame that waits for the bus: arbitration, order of queueing, time of it, frame, its bits, who sends it.
A plain tuple, as it costs an eighth of a named one and sorts by itself: the order is unique."""

# Named tuples past their own __new__, which takes half of the time that a frame would cost otherwise.
_new = tuple.__new__


class Port:
    """A node's CAN controller: `send` and `recv` of ports.Bus.

    It has as many transmit mailboxes as it takes and offers the one with the lowest identifier first
    (equal identifiers in order of queueing); it does not hear what it sends itself. number: of the port on
    its wire.
    """

    __slots__ = ("_inbox", "_wire", "accepted", "deliver", "name", "number")

    def __init__(self, wire: Wire, name: str, number: int, on_frame: Listener | None) -> None:
        self.name = name
        self.number = number
        self.accepted: Collection[int] | None = None
        self.deliver = on_frame or self._store
        self._wire = wire
        self._inbox: list[Received] = []

    def send(self, t: Nanos, frame: Frame) -> None:
        """Queues a frame at `t`, or now if `t` is past; BusError if it is no CAN frame."""
        self._wire.queue(t, frame, self)

    def recv(self, t: Nanos) -> list[Received]:
        """Returns what has arrived up to and including `t` since the last call."""
        arrived = self._inbox
        if arrived and arrived[-1].t > t:
            self._inbox = [received for received in arrived if received.t > t]
            return [received for received in arrived if received.t <= t]
        self._inbox = []
        return arrived

    def accept(self, identifiers: Collection[int] | None) -> None:
        """Sets the acceptance filter: standard frames with other identifiers are not heard; None: all are."""
        self.accepted = identifiers
        self._wire.refilter()

    def _store(self, t: Nanos, frame: Frame) -> None:
        self._inbox.append(_new(Received, (t, frame)))


class Wire:
    """The medium between ports; `advance` runs it, `on_transfer` is told every frame at its end.

    bitrate: bit/s, a bit must last whole nanoseconds (else BusError). Time starts long ago, so that a bench
    may boot its drives before t = 0.
    """

    def __init__(self, bitrate: int, on_transfer: Callable[[Transfer], None] | None = None) -> None:
        if bitrate <= 0 or SECOND % bitrate:
            raise BusError(f"bit rate {bitrate}: a bit must last a whole number of nanoseconds")
        self.bitrate = bitrate
        self.now = _LONG_AGO
        self._bit: Nanos = SECOND // bitrate
        self._on_transfer = on_transfer
        self._ports: list[Port] = []
        self._attached = 0
        self._hearers: dict[int, tuple[Listener, ...]] = {}  # by sender's number and identifier; made lazily
        self._ready: list[_Queued] = []
        self._waiting: list[tuple[Nanos, _Queued]] = []  # queued ahead of time
        self._flight: tuple[Nanos, Transfer, Port] | None = None  # when it ends, and what ends then
        self._free: Nanos = _LONG_AGO
        self._due: Nanos = _NEVER  # nothing can end before
        self._order = 0
        self._frames, self._busy, self._worst = 0, 0, 0

    def attach(self, name: str, on_frame: Listener | None = None) -> Port:
        """Adds a node. With `on_frame` it is called as the last bit of a frame arrives and may send at once;
        without it frames wait in the port until `recv`."""
        port = Port(self, name, self._attached, on_frame)
        self._attached += 1
        self._ports.append(port)
        self.refilter()
        return port

    def detach(self, port: Port) -> None:
        """Takes a node off; what it has queued is still sent."""
        self._ports.remove(port)
        self.refilter()

    def refilter(self) -> None:
        """Forgets who hears what: a node has come or gone, or has changed its filter."""
        self._hearers.clear()

    def queue(self, t: Nanos, frame: Frame, sender: Port) -> None:
        """Queues a frame of `sender` at `t`, or now if `t` is past."""
        bits = frame_bits(frame)
        identifier, _, extended, remote = frame
        key = arbitration(identifier, extended, remote)
        self._order = order = self._order + 1
        now = self.now
        if t <= now:
            heappush(self._ready, (key, order, now, frame, bits, sender))
        else:
            heappush(self._waiting, (t, (key, order, t, frame, bits, sender)))
        if t < self._due:
            self._due = t

    def advance(self, until: Nanos) -> None:
        """Runs everything that completes by `until`."""
        if until >= self._due:
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
        end, transfer, sender = flight
        self._flight = None
        self.now = end
        self._frames += 1
        self._busy += self._free - transfer.start
        if self._on_transfer is not None:
            self._on_transfer(transfer)
        frame = transfer.frame
        address = sender.number << 30 | (_EXTENDED if frame.extended else frame.id)
        hearers = self._hearers.get(address)
        if hearers is None:
            hearers = self._hearers[address] = self._find(sender, frame)
        for deliver in hearers:
            deliver(end, frame)
        return True

    @property
    def pending(self) -> int:
        """Frames that are queued or on the bus."""
        return len(self._ready) + len(self._waiting) + (self._flight is not None)

    def statistics(self) -> Statistics:
        """Returns the totals up to now."""
        return Statistics(self.now, self._frames, self._busy, self._worst)

    def _arbitrate(self, until: Nanos) -> tuple[Nanos, Transfer, Port] | None:
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
        _, _, queued, frame, bits, sender = heappop(ready)
        bit = self._bit
        end = start + bits * bit
        self._free = end + INTERFRAME_BITS * bit
        if start - queued > self._worst:
            self._worst = start - queued
        self._flight = flight = (end, _new(Transfer, (queued, start, end, frame, sender.name)), sender)
        return flight

    def _rest(self, until: Nanos) -> None:
        """Moves time on to `until`, by when nothing has ended, and tells when something may."""
        if until > self.now:
            self.now = until
        if self._flight is not None:
            self._due = self._flight[0]
        elif self._ready:
            self._due = until
        else:
            self._due = self._waiting[0][0] if self._waiting else _NEVER

    def _find(self, sender: Port, frame: Frame) -> tuple[Listener, ...]:
        """Returns the listeners that a frame of this sender reaches."""
        return tuple(
            port.deliver
            for port in self._ports
            if port is not sender and (port.accepted is None or frame.extended or frame.id in port.accepted)
        )
