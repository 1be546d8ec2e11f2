"""A node's CAN controller on the simulated wire."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import TYPE_CHECKING, TypeAlias

from hilbed.can.error_state import BUS_OFF, NO_POWER, ErrorState
from hilbed.clock import seconds
from hilbed.types import BusError, Frame, Nanos, Received

if TYPE_CHECKING:
    from hilbed.can.contests import Contests

Listener = Callable[[Nanos, Frame], None]

Queued: TypeAlias = "tuple[int, int, Nanos, Frame, int, Port]"
"""A frame that waits for the bus: arbitration, order of queueing, time of it, frame, its bits, who sends it.
A plain tuple, as it costs an eighth of a named one and sorts by itself: the order is unique."""

_new = tuple.__new__  # named tuples past their own __new__, which would take half of the time of a frame

MOST = 64
"""Frames that wait in a strict node before it says that its queue is full."""


class Port:
    """A node on the wire: `send` and `recv` of ports.Bus.

    It has as many transmit mailboxes as it takes and offers the one with the lowest identifier first
    (equal identifiers in order of queueing); it does not hear what it sends itself, unless it listens for it.
    number: of the port on its wire. errors: its counters and state. recovers: whether it comes back
    by itself after bus-off. lost: frames that it could not queue or had to drop. guarded: it does not take
    every frame.
    """

    __slots__ = (
        "_inbox", "_wire", "accepted", "deliver", "errors", "guarded", "lost", "name", "number",
        "on_error", "on_sent", "recovers", "strict",
    )  # fmt: skip

    def __init__(
        self, wire: Contests, name: str, number: int, on_frame: Listener | None, strict: bool
    ) -> None:
        self.name = name
        self.number = number
        self.accepted: Collection[int] | None = None
        self.deliver = on_frame or self._store
        self.on_sent: Listener | None = None
        self.on_error: Listener | None = None
        self.errors = ErrorState()
        self.recovers = True
        self.lost = 0
        self.strict = strict
        self.guarded = strict
        self._wire = wire
        self._inbox: list[Received] = []

    def send(self, t: Nanos, frame: Frame) -> None:
        """Queues a frame at `t`, or now if `t` is past.

        BusError if it is no CAN frame. A node that is bus-off drops it; a strict node says so by a BusError,
        there and where 64 frames wait already.
        """
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

    def listen(self, on_sent: Listener | None = None, on_error: Listener | None = None) -> None:
        """Has the node told its own frames when they are through, and error frames with what they cut off."""
        self.on_sent, self.on_error = on_sent, on_error
        self._wire.refilter()

    def fail(self, t: Nanos) -> None:
        """Puts the node into bus-off, as too many errors would."""
        self._wire.take_off(t, self, BUS_OFF)

    def recover(self, t: Nanos) -> None:
        """Asks the node to leave bus-off: it does after 128 times 11 recessive bits."""
        self._wire.recover(t, self)

    def unplug(self, t: Nanos) -> None:
        """Takes the node its power; what it has heard is lost as well."""
        self._wire.take_off(t, self, NO_POWER)
        self._inbox = []

    def plug(self, t: Nanos) -> None:
        """Gives the node power again: its counters are those of a new one."""
        self._wire.put_on(t, self)

    def empty(self) -> None:
        """Takes back what is queued and not on the bus yet."""
        self._wire.withdraw(self)

    def admits(self, t: Nanos, frame: Frame) -> bool:
        """Returns whether a frame can be queued, else counts it as lost; BusError if the node is strict."""
        why = self.errors.absent
        if self.strict and not why and self._wire.waiting(self) >= MOST:
            why = f"its transmit queue is full ({MOST} frames)"
        if not why:
            return True
        self.lost += 1
        if self.strict:
            raise BusError(f"t = {seconds(t):g} s: {self.name} cannot send {frame.id:03X}: {why}")
        return False

    def _store(self, t: Nanos, frame: Frame) -> None:
        self._inbox.append(_new(Received, (t, frame)))
