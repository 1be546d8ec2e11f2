"""A CAN 2.0 A/B medium in simulated time: exact frame lengths, arbitration, errors, latency, load.

Event driven: nothing happens between the ends of frames. A frame starts when the bus has been idle for
the interframe space and, of all frames offered by then, it has the lowest identifier. Starts are not
rounded to bit boundaries. As long as nothing is wrong no bit is looked at; where something is (two nodes
with one identifier, a disturbed bit, a node that is alone or has made errors), `trouble` is asked.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from heapq import heapify, heappop, heappush
from typing import TypeAlias

from hilbed.can.arbitration import arbitration
from hilbed.can.error_state import BUS_OFF
from hilbed.can.frame_length import INTERFRAME_BITS, frame_bits
from hilbed.can.port import Listener, Port, Queued
from hilbed.can.statistics import Statistics
from hilbed.can.trouble import Tamper, Trial, Trouble
from hilbed.clock import SECOND
from hilbed.types import NO_ERROR, BusError, Frame, Nanos, Transfer

_LONG_AGO: Nanos = -(1 << 62)
_NEVER: Nanos = 1 << 62
_MANY = 1 << 16  # identifiers whose senders are remembered
_EXTENDED = 1 << 29  # stands for every extended identifier where it is looked up who hears

_Flight: TypeAlias = "tuple[Nanos, Transfer, Queued, Trial | None]"
"""What is on the bus: when it ends, what ends then, the frame as it was queued; how it goes, if unusual."""

# Named tuples past their own __new__, which takes half of the time that a frame would cost otherwise.
_new = tuple.__new__


def _unnoticed(*_: object) -> None:
    """Hears of a state and does nothing."""


class Wire:
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
        on_state: Callable[[Nanos, str, str], None] = _unnoticed,
    ) -> None:
        if bitrate <= 0 or SECOND % bitrate:
            raise BusError(f"bit rate {bitrate}: a bit must last a whole number of nanoseconds")
        self.bitrate = bitrate
        self.now = _LONG_AGO
        self._bit: Nanos = SECOND // bitrate
        self._on_transfer = on_transfer
        self._ports: list[Port] = []
        self._attached = 0
        self._hearers: dict[int, tuple[Listener, ...]] = {}  # by sender's number and identifier; made lazily
        self._ready: list[Queued] = []
        self._waiting: list[tuple[Nanos, Queued]] = []  # queued ahead of time
        self._posted: deque[Callable[[], object]] = deque()
        self._flight: _Flight | None = None
        self._free: Nanos = _LONG_AGO
        self._due: Nanos = _NEVER  # nothing can end before
        self._order = 0
        self._frames, self._errors, self._busy, self._worst = 0, 0, 0, 0
        self._trouble = Trouble(self._ports, self._bit, on_state)
        self._owners: dict[int, Port | None] = {}  # who sends, by arbitration; None: several
        self._shared = False  # several nodes send one identifier
        self._odd = True  # something may not go smoothly
        self._tamper: Tamper | None = None
        self.queue: Callable[[Nanos, Frame, Port], None] = self._queue
        """Queues a frame of a port at a time, or now if that is past."""

    def attach(self, name: str, on_frame: Listener | None = None, strict: bool = False) -> Port:
        """Adds a node. With `on_frame` it is called as the last bit of a frame arrives and may send at once;
        without it frames wait in the port until `recv`. strict: see `Port.send`."""
        port = Port(self, name, self._attached, on_frame, strict)
        self._attached += 1
        self._ports.append(port)
        self._review()
        return port

    def detach(self, port: Port) -> None:
        """Takes a node off; what it has queued is still sent, if that goes at the first attempt."""
        self._ports.remove(port)
        self._trouble.forget(port)
        self._review()

    def port(self, name: str) -> Port:
        """Returns the first node with that name; KeyError where there is none."""
        for port in self._ports:
            if port.name == name:
                return port
        raise KeyError(name)

    def relax(self) -> None:
        """Lets strict nodes be strict no more and takes back what they have queued, for it is too late."""
        for port in self._ports:
            if port.strict:
                port.strict = False
                self.withdraw(port)
        self._review()

    def tamper(self, tamper: Tamper | None) -> None:
        """Lets somebody meddle with the frames from now on; None: nobody any more."""
        self._tamper = self._trouble.tamper = tamper
        self.queue = self._queue if tamper is None else self._queue_tampered
        self._review()

    def refilter(self) -> None:
        """Forgets who hears what: a node has come or gone, or has changed its filter."""
        self._hearers.clear()

    def later(self, act: Callable[[], object]) -> None:
        """Has something done at the next `advance`; may be called from any thread."""
        self._posted.append(act)
        self._due = _LONG_AGO

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

    # ---- queues

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

    # ---- time

    def _arbitrate(self, until: Nanos) -> _Flight | None:
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
            self._due = self._waiting[0][0] if self._waiting else _NEVER

    def _find(self, sender: Port, frame: Frame) -> tuple[Listener, ...]:
        """Returns the listeners that a frame of this sender reaches."""
        told = tuple(
            port.deliver
            for port in self._ports
            if port is not sender
            and not port.errors.absent
            and (port.accepted is None or frame.extended or frame.id in port.accepted)
        )
        return told if sender.on_sent is None else (*told, sender.on_sent)

    # ---- what does not go smoothly

    def _contest(self, start: Nanos, until: Nanos) -> _Flight | None:
        """Starts a frame at `start` or when a suspended node may, if that is before `until`."""
        ready, waiting = self._ready, self._waiting
        while start < until:
            while waiting and waiting[0][0] <= start:
                heappush(ready, heappop(waiting)[1])
            items = self._front(start)
            if items:
                return self._launch(items, start)
            start = self._trouble.released(start, self._free)
            if waiting and waiting[0][0] < start:
                start = waiting[0][0]
        return None

    def _front(self, start: Nanos) -> list[Queued]:
        """Takes out the frames that win arbitration: one, or one each of nodes with the same identifier."""
        ready, barred = self._ready, self._trouble.barred(start, self._free)
        front: list[Queued] = []
        held: list[Queued] = []
        while ready and (not front or ready[0][0] == front[0][0]):
            item = heappop(ready)
            late = item[5] in barred or any(item[5] is other[5] for other in front)
            (held if late else front).append(item)
        for item in held:
            heappush(ready, item)
        return front

    def _launch(self, items: list[Queued], start: Nanos) -> _Flight | None:
        """Puts frames of one identifier on the bus together."""
        trouble = self._trouble
        self._welcome(start)
        if self._on_transfer is None and trouble.alone([item[5] for item in items]):
            for item in items:
                heappush(self._ready, item)
            return None
        attempt = trouble.attempt(items, start, self._free)
        senders = [items[k] for k in attempt.senders]
        _, _, queued, frame, _, _ = senders[0]
        end = start + attempt.bits * self._bit
        self._free = end + INTERFRAME_BITS * self._bit
        if not attempt.error:
            self._worst = max(self._worst, start - queued)
        names = "+".join(item[5].name for item in senders)
        transfer = Transfer(queued, start, end, frame, names, attempt.error)
        self._flight = flight = (end, transfer, items[0], Trial(attempt, items))
        return flight

    def _settle(self, transfer: Transfer, trial: Trial) -> None:
        """Ends an attempt: who is through, who tries again, who is bus-off, who hears what."""
        end, error = transfer.end, transfer.error
        bus_off = self._trouble.settle(end, trial)
        if error:
            self._errors += 1
        else:
            self._frames += 1
        if self._on_transfer is not None:
            self._on_transfer(transfer)
        senders = []
        for k, item in enumerate(trial.items):
            sender = item[5]
            if k in trial.attempt.senders:
                senders.append(sender)
            through = not error and k in trial.attempt.senders
            if not through and sender in self._ports and not sender.errors.absent:
                heappush(self._ready, item)
        for port in bus_off:
            self.take_off(end, port, BUS_OFF)
        self._review()
        overruled = [item[5] for item in trial.items if item[5] not in senders]
        for port in [port for port in self._ports if not (port.errors.absent or port in overruled)]:
            _tell(port, transfer, port in senders)

    def take_off(self, t: Nanos, port: Port, why: str) -> None:
        """Lets a node take part no more: BUS_OFF or NO_POWER; what it has queued is lost."""
        self._trouble.lost(t, port, why)
        port.lost += self.withdraw(port)
        self._review()

    def put_on(self, t: Nanos, port: Port) -> None:
        """Lets a node take part again as a new one."""
        self._trouble.back(t, port)
        self._review()

    def recover(self, t: Nanos, port: Port) -> None:
        """Lets a node that is bus-off come back after 128 times 11 recessive bits from `t` on."""
        self._trouble.begin_recovery(t, port)
        self._due = min(self._due, self.now)

    def _welcome(self, until: Nanos) -> None:
        if self._trouble.recovered(until, self._free):
            self._review()

    def _review(self) -> None:
        """Finds out whether frames go smoothly from now on."""
        self._odd = self._shared or self._trouble.expected
        for port in self._ports:
            port.guarded = port.strict or bool(port.errors.absent)
        self.refilter()
        if self._odd or self._ready:
            self._due = min(self._due, self.now)


def _tell(port: Port, transfer: Transfer, sent: bool) -> None:
    frame = transfer.frame
    if transfer.error:
        listener = port.on_error
    elif sent:
        listener = port.on_sent
    else:
        heard = port.accepted is None or frame.extended or frame.id in port.accepted
        listener = port.deliver if heard else None
    if listener is not None:
        listener(transfer.end, frame)
