"""A controller that falls silent, the fault that comes of it, and its reset."""

from __future__ import annotations

from collections.abc import Iterator

from hilbed.can import cia402, nmt
from hilbed.can.sdo import SdoError
from hilbed.clock import MILLISECOND, seconds
from hilbed.conformance.checks.states import transition
from hilbed.conformance.expected import COMMANDS
from hilbed.conformance.motion import braking, expected_braking
from hilbed.conformance.result import Result, judged, told, unsupported
from hilbed.conformance.subject import Subject
from hilbed.types import Nanos

CONSUMER: Nanos = 100 * MILLISECOND
LATE: Nanos = 100 * MILLISECOND
"""By which the drive may be later than its consumer time."""
HEARTBEAT_LOST = 0x8130
_FAULT, _QUICK_STOP = 1, 3  # values of 6007


def heartbeat(subject: Subject) -> Iterator[Result]:
    """The drive says that the controller's heartbeat is lost; the motor has no power."""
    subject.manage(nmt.START)
    try:
        with subject.guarded(CONSUMER):
            before = len(subject.emergencies)
    except SdoError as error:
        yield unsupported("heartbeat", f"1016:01: abort {error.code:08X}")
        return
    heard = subject.link.until(lambda: len(subject.emergencies) > before, CONSUMER + LATE)
    if not heard:
        yield told("heartbeat/emergency", False, f"none within {(CONSUMER + LATE) // MILLISECOND} ms")
        return
    t, code = subject.emergencies[before]
    note = f"code {code:04X}, consumer time {CONSUMER // MILLISECOND} ms"
    if code != HEARTBEAT_LOST:
        yield told("heartbeat/emergency", False, f"{note}; {HEARTBEAT_LOST:04X} expected")
        return
    yield judged(
        "heartbeat/emergency", (t - subject.alive) / MILLISECOND, (CONSUMER + LATE) / MILLISECOND, "ms", note
    )


def abandoned(speed: float, subject: Subject) -> Iterator[Result]:
    """The wheel turns, the controller falls silent: time and turn until standstill."""
    try:
        with subject.guarded(CONSUMER):
            subject.write("abort_option", _QUICK_STOP)
            subject.run(speed)
    except SdoError as error:
        yield unsupported("abandoned", str(error))
        return
    limit = seconds(CONSUMER + LATE) + expected_braking(subject, speed).time
    yield judged("abandoned/standstill", braking(subject, speed).time, limit, "s", f"from {speed:g} rad/s")


def fault(subject: Subject) -> Iterator[Result]:
    """A lost heartbeat as a fault: what the drive says, what it refuses, and how it is reset."""
    subject.target(0.0)
    try:
        with subject.guarded(CONSUMER):
            subject.write("abort_option", _FAULT)
            subject.manage(nmt.START)
            subject.go(cia402.ENABLED)
            before = len(subject.emergencies)
    except SdoError as error:
        yield unsupported("fault", str(error))
        return
    state, _ = subject.reach((cia402.FAULT,))
    if state != cia402.FAULT:
        yield told("fault/reached", False, f"{state} after the controller fell silent, 6007 = {_FAULT}")
        return
    yield told("fault/reached", True)
    code = subject.read("error_code") if subject.has("error_code") else 0
    yield told("fault/error code", code != 0, f"603F is {code:04X}")
    yield told("fault/emergency", len(subject.emergencies) > before)
    for command in COMMANDS:
        if command != "fault reset":
            yield transition(subject, cia402.FAULT, command)
    subject.command(cia402.DISABLE_VOLTAGE)
    yield transition(subject, cia402.FAULT, "fault reset")
    subject.command(cia402.DISABLE_VOLTAGE)
    code = subject.read("error_code") if subject.has("error_code") else 0
    yield told("fault/cleared", code == 0, f"603F is {code:04X}")
