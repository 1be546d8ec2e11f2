"""What a wire has to look at once something is unusual: counters, suspended senders, bus-off and recovery."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from typing import NamedTuple, Protocol

from hilbed.can.attempt import Attempt, Contender, Listeners, attempt
from hilbed.can.error_state import BUS_OFF
from hilbed.can.frame_layout import layout
from hilbed.can.port import Port, Queued
from hilbed.can.recovery import Recovery
from hilbed.types import ACK_ERROR, NO_ERROR, Frame, Nanos

SUSPEND_BITS = 8
"""An error-passive node that has just sent waits for so many bits longer than the others."""

OVERRULED_BITS = SUSPEND_BITS + 6
"""One that was overruled meanwhile, too: its flag and delimiter end six bits after the other's frame."""

_QUIET_BITS = 11  # recessive at the end of every frame, interframe space included


class Tamper(Protocol):
    """Somebody who meddles with frames."""

    def queued(self, t: Nanos, frame: Frame, node: str) -> Sequence[Nanos]:
        """Returns when a frame that a node queues at `t` is really queued: never, later, twice."""
        ...

    def disturbed(self, t: Nanos, frame: Frame, node: str) -> int | None:
        """Returns the index of the bit that is inverted in a frame which starts at `t`, None for none."""
        ...


class Trial(NamedTuple):
    """An attempt and the frames that took part in it, each of another node."""

    attempt: Attempt
    items: Sequence[Queued]


class Trouble:
    """Judges frames and keeps the books of errors for the ports of a wire; bit: ns.

    on_state: told the time, a node's name and its state whenever that changes.
    """

    def __init__(
        self, ports: Sequence[Port], bit: Nanos, on_state: Callable[[Nanos, str, str], None]
    ) -> None:
        self.tamper: Tamper | None = None
        self._suspended: dict[Port, int] = {}  # by how many bits
        self._ports = ports
        self._bit = bit
        self._on_state = on_state
        self._recovery = Recovery(bit)

    @property
    def expected(self) -> bool:
        """A frame may not go as it should."""
        present = sum(not port.errors.absent for port in self._ports)
        spotless = all(port.errors.spotless for port in self._ports)
        return self.tamper is not None or present < 2 or not spotless

    @property
    def recovering(self) -> bool:
        return bool(self._recovery)

    def barred(self, start: Nanos, free: Nanos) -> Collection[Port]:
        """Returns who may not start a frame at `start`; free: since when the others may."""
        return [port for port, bits in self._suspended.items() if start < free + bits * self._bit]

    def released(self, start: Nanos, free: Nanos) -> Nanos:
        """Returns when the next of those who may not start at `start` may."""
        ends = [free + bits * self._bit for bits in self._suspended.values()]
        return min(end for end in ends if end > start)

    def alone(self, senders: Sequence[Port]) -> bool:
        """Nobody hears these, they have long found out, and nobody is on the way back."""
        if self._recovery or any(not port.errors.passive for port in senders):
            return False
        return not self._others(senders)

    def attempt(self, items: Sequence[Queued], start: Nanos, free: Nanos) -> Attempt:
        """Returns how frames go that start together; free: end of the interframe space before."""
        self._recovery.interrupted(free - _QUIET_BITS * self._bit, start)
        senders = [item[5] for item in items]
        others = self._others(senders)
        listeners = Listeners(bool(others), any(not port.errors.passive for port in others))
        disturbed = None
        if self.tamper is not None:
            disturbed = self.tamper.disturbed(start, items[0][3], senders[0].name)
        if len(items) == 1 and others and disturbed is None:
            return Attempt(items[0][4], NO_ERROR, (0,))
        contenders = [
            Contender(layout(item[3]), not port.errors.passive)
            for item, port in zip(items, senders, strict=True)
        ]
        return attempt(contenders, listeners, disturbed)

    def settle(self, t: Nanos, trial: Trial) -> list[Port]:
        """Enters how an attempt ended into the counters; returns the nodes that are bus-off by it."""
        (_, error, through, first), items = trial
        senders = [item[5] for item in items]
        before = {port: port.errors.state for port in self._ports}
        for k, port in enumerate(senders):
            if k in through and not error:
                port.errors.sent()
            else:
                port.errors.failed_to_send(unanswered=error == ACK_ERROR)
        for port in self._others(senders):
            if error:
                port.errors.failed_to_receive(first and not port.errors.passive)
            else:
                port.errors.received()
        self._suspended = {
            port: SUSPEND_BITS if error or k in through else OVERRULED_BITS
            for k, port in enumerate(senders)
            if port.errors.passive
        }
        changed = [port for port, state in before.items() if port.errors.state != state]
        for port in changed:
            self._on_state(t, port.name, port.errors.state)
        return [port for port in changed if port.errors.absent]

    def lost(self, t: Nanos, port: Port, why: str) -> None:
        """A node takes no part any more."""
        if port.errors.absent != why:
            port.errors.absent = why
            self._on_state(t, port.name, why)
        self._recovery.forget(port)
        if why == BUS_OFF and port.recovers:
            self._recovery.begin(t, port)

    def back(self, t: Nanos, port: Port) -> None:
        """A node takes part again."""
        self._recovery.forget(port)
        port.errors.restart()
        self._on_state(t, port.name, port.errors.state)

    def begin_recovery(self, t: Nanos, port: Port) -> None:
        if port.errors.absent == BUS_OFF:
            self._recovery.begin(t, port)

    def recovered(self, t: Nanos, free: Nanos) -> list[Port]:
        """Returns who has come back by `t`, up to when the bus was idle since before `free`."""
        found = []
        while (back := self._recovery.next(free - _QUIET_BITS * self._bit)) and back[0] <= t:
            self.back(*back)
            found.append(back[1])
        return found

    def forget(self, port: Port) -> None:
        """A node has left the wire."""
        self._recovery.forget(port)

    def _others(self, senders: Collection[Port]) -> list[Port]:
        return [port for port in self._ports if port not in senders and not port.errors.absent]
