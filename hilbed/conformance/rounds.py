"""Rounds of SYNC and answers, on a quiet bus or on one that is filled with other frames."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from hilbed.can import nmt
from hilbed.can.cob import SYNC_FRAME
from hilbed.can.frame_length import INTERFRAME_BITS, frame_bits
from hilbed.can.link import Link
from hilbed.clock import MILLISECOND, seconds
from hilbed.conformance.subject import Subject
from hilbed.conformance.tpdo import Tpdo
from hilbed.types import BusError, Frame, Nanos, Received

PERIOD: Nanos = 10 * MILLISECOND
PATIENCE: Nanos = 100 * MILLISECOND
"""After which a SYNC is taken to have no answer."""
BURST = 8
"""As many other frames at a time: drivers have short queues, and the drive has to be heard in between."""
FILLER = Frame(0x1FFFFFFF, bytes(range(0x51, 0x59)), True)
"""Loses every arbitration, and no node heeds it."""


class Rounds(NamedTuple):
    """Times (ns) from SYNC to each TPDO, by name; bits that crossed the bus, and in which time (ns).

    syncs: how many there were; refused: other frames that the bus's driver did not take.
    """

    answers: dict[str, list[Nanos]]
    syncs: int
    bits: int
    refused: int
    length: Nanos

    @property
    def in_time(self) -> bool:
        """Whether every TPDO answered every SYNC, in the mean before the next one."""
        return all(
            len(times) == self.syncs and sum(times) <= self.syncs * PERIOD for times in self.answers.values()
        )


def synchronous(subject: Subject) -> list[str]:
    """Returns the TPDOs of the table that are sent at every SYNC."""
    table = subject.node.table
    return [name for name in table.sends if table.pdos[name].transmission == 1]


def rounds(subject: Subject, names: Sequence[str], count: int, fillers: float = 0.0) -> Rounds:
    """Sends SYNC every 10 ms, once the one before is answered, and `fillers` other frames a second.

    Ends with the first SYNC that is not answered.
    """
    link = subject.link
    subject.manage(nmt.ENTER_PREOPERATIONAL)
    tpdos = {name: Tpdo(subject, name) for name in names}
    for tpdo in tpdos.values():
        tpdo.off()
        tpdo.on()
    subject.manage(nmt.START)
    meter = _Meter({tpdo.cob_id: name for name, tpdo in tpdos.items()})
    filler = _Filler(link.send, fillers, meter)
    link.listeners.append(meter.hear)
    link.each_step.append(filler.fill)
    try:
        meter.start(link)  # a node that has just been started may be late with its first answer
        link.until(meter.answered, PATIENCE)
        meter.clear()
        begun, syncs = link.t, 0
        while syncs < count:
            due, syncs = link.t + PERIOD, syncs + 1
            meter.start(link)
            if not link.until(meter.answered, PATIENCE):
                break
            link.pause(due - link.t)
    finally:
        link.listeners.remove(meter.hear)
        link.each_step.remove(filler.fill)
    return Rounds(meter.answers, syncs, meter.bits, filler.refused, link.t - begun)


class _Meter:
    """Counts bits and times answers: the first one of each TPDO after a SYNC."""

    def __init__(self, names: dict[int, str]) -> None:
        self._names = names
        self._missing: set[str] = set()
        self.answers: dict[str, list[Nanos]] = {name: [] for name in names.values()}
        self._sync: Nanos = 0
        self.bits = 0

    def start(self, link: Link) -> None:
        """Sends SYNC."""
        self._missing = {*self.answers}
        self._sync = link.t
        self.count(SYNC_FRAME)
        link.send(SYNC_FRAME)

    def answered(self) -> bool:
        """Tells whether every TPDO has come since SYNC."""
        return not self._missing

    def clear(self) -> None:
        """Forgets what has been so far."""
        self.bits = 0
        for times in self.answers.values():
            times.clear()

    def count(self, frame: Frame) -> None:
        """Takes a frame that crosses the bus."""
        self.bits += frame_bits(frame) + INTERFRAME_BITS

    def hear(self, received: Received) -> None:
        """Takes a frame that has arrived."""
        t, frame = received
        self.count(frame)
        name = None if frame.extended else self._names.get(frame.id)
        if name in self._missing:
            self._missing.remove(name)
            self.answers[name].append(t - self._sync)


class _Filler:
    """Sends so many frames a second, as far as the bus takes them: what is late is not made up for."""

    def __init__(self, send: Callable[[Frame], None], rate: float, meter: _Meter) -> None:
        self._send = send
        self._rate = rate
        self._meter = meter
        self._owed = 0.0
        self._last: Nanos | None = None
        self.refused = 0

    def fill(self, t: Nanos) -> None:
        """Sends what is due at t."""
        if self._last is not None:
            self._owed = min(self._owed + self._rate * seconds(t - self._last), BURST)
        self._last = t
        while self._owed >= 1.0:
            self._owed -= 1.0
            try:
                self._send(FILLER)
            except BusError:  # its queue is full: this is all that it takes
                self.refused += 1
                self._owed = 0.0
                return
            self._meter.count(FILLER)
