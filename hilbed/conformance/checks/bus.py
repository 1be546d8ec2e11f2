"""Answers to SYNC, on a quiet bus and on a busy one; the motor has no power."""

from __future__ import annotations

from collections.abc import Iterator

from hilbed.can.frame_length import INTERFRAME_BITS, frame_bits
from hilbed.clock import MILLISECOND, seconds
from hilbed.conformance.result import Result, judged, told, unsupported
from hilbed.conformance.rounds import FILLER, PERIOD, Rounds, rounds, synchronous
from hilbed.conformance.subject import Subject

ROUNDS = 100
LOAD = 0.9
"""Share of the bus that is aimed at; the check asks for 80 to 100 %."""


def quiet(subject: Subject) -> Iterator[Result]:
    """Time from SYNC to each TPDO of the table that is sent at every SYNC."""
    names = synchronous(subject)
    if not names:
        yield unsupported("sync", "the table has no TPDO at every SYNC")
        return
    yield from _answers("sync", rounds(subject, names, ROUNDS))


def busy(bitrate: int, timed: bool, subject: Subject) -> Iterator[Result]:
    """The same at a load of 80 to 100 % of the bit rate.

    timed: the bus takes time for its bits. Where it does not, or where this computer cannot send that much,
    the highest rate reached is named, and only the answers are judged.
    """
    names = synchronous(subject)
    if not names:
        yield unsupported("load", "the table has no TPDO at every SYNC")
        return
    register = subject.read("error_register") if subject.has("error_register") else 0
    done = rounds(subject, names, ROUNDS, LOAD * bitrate / (frame_bits(FILLER) + INTERFRAME_BITS))
    load = done.bits / (bitrate * seconds(done.length))
    about = f"{(done.fillers) / seconds(done.length):.0f} other frames/s, {done.refused} refused"
    if timed:
        yield told("load/reached", 0.8 <= load <= 1.0, about, 100 * load, "%")
    else:
        yield told("load/reached", True, f"highest rate on this bus: {about}", 100 * load, "%")
    yield from _answers("load", done)
    after = subject.read("error_register") if subject.has("error_register") else 0
    yield told("load/no error", after == register, f"error register {after:02X}")


def _answers(check: str, done: Rounds) -> Iterator[Result]:
    for name, times in done.answers.items():
        if len(times) < ROUNDS:
            yield told(f"{check}/{name}", False, f"{ROUNDS - len(times)} of {ROUNDS} SYNCs without an answer")
            continue
        mean = sum(times) / len(times) / MILLISECOND
        worst = max(times) / MILLISECOND
        yield judged(f"{check}/{name}", worst, PERIOD / MILLISECOND, "ms", f"mean {mean:.3f} ms")
