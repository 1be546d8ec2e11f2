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
LEAST = 0.02
_FILLER_BITS = frame_bits(FILLER) + INTERFRAME_BITS


def quiet(subject: Subject) -> Iterator[Result]:
    """Time from SYNC to each TPDO of the table that is sent at every SYNC."""
    names = synchronous(subject)
    if not names:
        yield unsupported("sync", "the table has no TPDO at every SYNC")
        return
    yield from _answers("sync", rounds(subject, names, ROUNDS))


def busy(bitrate: int, exact: bool, subject: Subject) -> Iterator[Result]:
    """The same on a bus that is loaded by 80 to 100 % of its bit rate.

    exact: the bus is the simulated wire, which takes any load. On any other one the load is lessened until
    every SYNC is answered in time: the highest one so reached is named, and need not be 80 %.
    """
    names = synchronous(subject)
    if not names:
        yield unsupported("load", "the table has no TPDO at every SYNC")
        return
    before = _errors(subject)
    aim = LOAD
    done = rounds(subject, names, ROUNDS, aim * bitrate / _FILLER_BITS)
    while not (exact or done.in_time or aim < LEAST):
        aim *= 0.6
        done = rounds(subject, names, ROUNDS, aim * bitrate / _FILLER_BITS)
    load = done.bits / (bitrate * seconds(done.length))
    what = "load" if exact else "highest load with answers in time"
    about = f"{what}, of {bitrate} bit/s; {done.refused} frames refused by the driver"
    yield told("load/reached", 0.8 <= load <= 1.0 or not exact, about, 100 * load, "%")
    yield from _answers("load", done)
    after = _errors(subject)
    yield told("load/no error", after == before, f"error register {after:02X}")


def _errors(subject: Subject) -> int:
    return subject.read("error_register") if subject.has("error_register") else 0


def _answers(check: str, done: Rounds) -> Iterator[Result]:
    for name, times in done.answers.items():
        if len(times) < done.syncs:
            yield told(f"{check}/{name}", False, f"SYNC number {done.syncs} has no answer")
            continue
        mean = sum(times) / len(times) / MILLISECOND
        note = f"mean; {min(times) / MILLISECOND:.3f} to {max(times) / MILLISECOND:.3f} ms"
        yield judged(f"{check}/{name}", mean, PERIOD / MILLISECOND, "ms", note)
