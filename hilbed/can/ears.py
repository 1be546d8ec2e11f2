"""What drives in operation say besides their measurements: emergencies, heartbeats, changes of state."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple

from hilbed.can import cia402, emergency, nmt
from hilbed.can.axis import STATE_BITS, STATUS, Axis
from hilbed.can.cob import EMERGENCY, HEARTBEAT
from hilbed.types import Nanos, Received

_MOST_EVENTS = 1000  # the first ones tell what went wrong


class BusEvent(NamedTuple):
    """Something a drive did that it should not: when, who, what."""

    t: Nanos
    drive: str
    text: str


class Ears:
    """Hears everything that is no PDO; `events` in the order of hearing, `ignored` counts the rest."""

    def __init__(self, axes: Iterable[Axis]) -> None:
        self._axes = tuple(axes)
        self.events: list[BusEvent] = []
        self.ignored = 0
        self._heeded: dict[int, tuple[Axis, Callable[[Axis, Received], None]]] = {}
        for axis in self._axes:
            self._heeded[EMERGENCY + axis.node.id] = axis, self._emergency
            self._heeded[HEARTBEAT + axis.node.id] = axis, self._heartbeat

    def hear(self, received: Received) -> None:
        """Takes a frame of any content."""
        frame = received.frame
        heeded = self._heeded.get(frame.id)
        if heeded is None or frame.extended or frame.remote:
            self.ignored += 1
            return
        axis, take = heeded
        take(axis, received)

    def new_state(self, t: Nanos, axis: Axis) -> None:
        """Notes the state of a statusword that has changed, unless it is the wanted one."""
        statusword = axis.values[STATUS]
        axis.state = statusword & STATE_BITS
        state = cia402.state_of(statusword)
        if state != cia402.ENABLED:
            self.note(t, axis, f"{state} (statusword {statusword:04X})")

    def note(self, t: Nanos, axis: Axis, text: str) -> None:
        """Adds an event."""
        if len(self.events) < _MOST_EVENTS:
            self.events.append(BusEvent(t, axis.node.name, text))

    def _emergency(self, axis: Axis, received: Received) -> None:
        said = emergency.decode(received.frame)
        if said is None:
            self.ignored += 1
            return
        code = said[1].code
        self.note(received.t, axis, f"emergency {code:04X}: {emergency.meaning(code)}")

    def _heartbeat(self, axis: Axis, received: Received) -> None:
        data = received.frame.data
        if len(data) != 1:
            self.ignored += 1
            return
        for other in self._axes:
            if other.node.id == axis.node.id:
                other.alive = received.t
        if data[0] != nmt.OPERATIONAL:
            state = nmt.STATE_NAMES.get(data[0], f"in the unknown state {data[0]:#x}")
            self.note(received.t, axis, f"no longer operational: {state}")
