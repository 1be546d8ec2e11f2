"""The nodes of a wire, and how their frames go where something may be wrong."""

from __future__ import annotations

from collections.abc import Callable
from heapq import heappop, heappush
from typing import TypeAlias

from hilbed.can.error_state import BUS_OFF
from hilbed.can.frame_length import INTERFRAME_BITS
from hilbed.can.port import Listener, Port, Queued
from hilbed.can.queues import LONG_AGO, Queues
from hilbed.can.trouble import Tamper, Trial, Trouble
from hilbed.types import Frame, Nanos, Transfer

Flight: TypeAlias = "tuple[Nanos, Transfer, Queued, Trial | None]"
"""What is on the bus: when it ends, what ends then, the frame as it was queued; how it goes, if unusual."""


def unnoticed(*_: object) -> None:
    """Hears of a state and does nothing."""


class Contests(Queues):
    """Nodes that come, go, leave the bus and return; attempts that are looked at bit by bit.

    bit: ns; on_transfer, on_state: see Wire.
    """

    def __init__(
        self,
        bit: Nanos,
        on_transfer: Callable[[Transfer], None] | None,
        on_state: Callable[[Nanos, str, str], None],
    ) -> None:
        super().__init__()
        self._bit = bit
        self._on_transfer = on_transfer
        self._ports: list[Port] = []
        self._attached = 0
        self._hearers: dict[int, tuple[Listener, ...]] = {}  # by sender's number and identifier; made lazily
        self._flight: Flight | None = None
        self._free: Nanos = LONG_AGO
        self._frames, self._errors, self._worst = 0, 0, 0
        self._trouble = Trouble(self._ports, bit, on_state)

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

    def _contest(self, start: Nanos, until: Nanos) -> Flight | None:
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

    def _launch(self, items: list[Queued], start: Nanos) -> Flight | None:
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
