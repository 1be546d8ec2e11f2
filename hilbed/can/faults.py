"""Does to a wire what the disturbances of a scenario say, and remembers what came of it."""

from __future__ import annotations

from collections.abc import Sequence

from hilbed.can.babbler import Babbler
from hilbed.can.cob import HEARTBEAT
from hilbed.can.ears import BusEvent
from hilbed.can.frame_layout import beyond_arbitration, layout
from hilbed.can.wire import Wire
from hilbed.effects import Babble, Effects, FrameFault
from hilbed.types import Frame, Nanos

_MOST_EVENTS = 200
_TRAILER_BITS = 10  # behind the CRC: an error there would be one of form or acknowledgement
_DONE = {
    "drop": "lost",
    "delay": "delayed",
    "duplicate": "sent twice",
    "corrupt": "corrupted",
    "silence": "lost, all heartbeats",
}


class Faults:
    """Meddles with frames (`trouble.Tamper`), takes nodes off the bus, lets strangers on it.

    `note` is for the wire's on_state.
    """

    def __init__(self) -> None:
        self._wire: Wire | None = None
        self._frames: Sequence[FrameFault] = ()
        self._off: set[str] = set()
        self._babblers: dict[Babble, Babbler] = {}
        self._strangers: list[Babbler] = []
        self._states: list[BusEvent] = []
        self._hits: dict[tuple[str, str], tuple[Nanos, int]] = {}

    def join(self, wire: Wire) -> None:
        """Gets to know the wire."""
        self._wire = wire

    def note(self, t: Nanos, node: str, state: str) -> None:
        """Notes that a node's error state has changed."""
        if len(self._states) < _MOST_EVENTS:
            self._states.append(BusEvent(t, node, state))

    @property
    def events(self) -> list[BusEvent]:
        """What happened: changes of error states, and how many frames were hit, in order of time."""
        hits = [
            BusEvent(t, node, f"{count} frame{'s' * (count > 1)} {_DONE.get(what, what)}")
            for (node, what), (t, count) in self._hits.items()
        ]
        babbled = [BusEvent(one.begun, "babbler", f"{one.sent} frames sent") for one in self._strangers]
        return sorted(self._states + hits + babbled, key=lambda event: event.t)

    def update(self, t: Nanos, effects: Effects) -> None:
        """Does what has changed among the effects."""
        wire = self._wire
        assert wire is not None
        frames = tuple(effects.frames)
        if frames != self._frames:
            self._frames = frames
            wire.tamper(self if frames else None)
        for name in sorted(effects.bus_off ^ self._off):
            port, off = wire.port(name), name in effects.bus_off
            port.recovers = not off
            (port.fail if off else port.recover)(t)
        self._off = set(effects.bus_off)
        self._babble(t, wire, effects.babble)

    def queued(self, t: Nanos, frame: Frame, node: str) -> Sequence[Nanos]:
        """Returns when a frame is really queued."""
        times = [t]
        for fault in self._frames:
            if fault.action == "corrupt" or not _meant(fault, frame, node) or not times or not _hits(fault):
                continue
            self._count(t, node, fault.action)
            if fault.action == "delay":
                times = [time + fault.delay for time in times]
            else:
                times = times * 2 if fault.action == "duplicate" else []
        return times

    def disturbed(self, t: Nanos, frame: Frame, node: str) -> int | None:
        """Returns the index of the inverted bit, from behind the arbitration field to the end of the CRC."""
        for fault in self._frames:
            if fault.action == "corrupt" and _meant(fault, frame, node) and _hits(fault):
                self._count(t, node, fault.action)
                first, last = beyond_arbitration(frame), len(layout(frame)) - _TRAILER_BITS
                return int(fault.rng.integers(first, last))
        return None

    def _babble(self, t: Nanos, wire: Wire, babbles: Sequence[Babble]) -> None:
        for babble in [one for one in self._babblers if one not in babbles]:
            self._babblers.pop(babble).stop()
        for babble in babbles:
            if babble not in self._babblers:
                self._babblers[babble] = Babbler(t, wire, babble)
                self._strangers.append(self._babblers[babble])

    def _count(self, t: Nanos, node: str, what: str) -> None:
        first, count = self._hits.get((node, what), (t, 0))
        self._hits[node, what] = first, count + 1


def _meant(fault: FrameFault, frame: Frame, node: str) -> bool:
    if fault.node not in (None, node):
        return False
    if fault.action == "silence":
        return not frame.extended and HEARTBEAT < frame.id < HEARTBEAT + 128
    return fault.identifier is None or (frame.id == fault.identifier and not frame.extended)


def _hits(fault: FrameFault) -> bool:
    return fault.probability >= 1.0 or fault.rng.random() < fault.probability
