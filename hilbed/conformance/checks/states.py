"""Every command in every state: what must lead on does, what must not changes nothing."""

from __future__ import annotations

from collections.abc import Iterator

from hilbed.can import cia402
from hilbed.can.sdo import SdoError
from hilbed.clock import MILLISECOND
from hilbed.conformance.expected import COMMANDS, POWERED, after
from hilbed.conformance.result import Result, told, unsupported
from hilbed.conformance.subject import STATE_TIMEOUT, Subject
from hilbed.types import Nanos

PATIENCE: Nanos = 50 * MILLISECOND
"""After which a drive that has not heeded a command is taken to have refused it."""
STAYING = (5, 6, 7)
"""Values of 605A by which a drive stays in quick stop active."""


def unpowered(subject: Subject) -> Iterator[Result]:
    """States without power, and the commands that keep it off."""
    for state in (cia402.DISABLED, cia402.READY, cia402.SWITCHED_ON):
        for command in COMMANDS:
            if not {*POWERED} & {*after(state, command)}:
                subject.go(state)
                yield transition(subject, state, command)


def powered(subject: Subject) -> Iterator[Result]:
    """Commands into and out of operation enabled, and those of quick stop active; the wheel stands."""
    subject.target(0.0)
    for state in (cia402.READY, cia402.SWITCHED_ON, cia402.ENABLED):
        for command in COMMANDS:
            if state == cia402.ENABLED or {*POWERED} & {*after(state, command)}:
                subject.go(state)
                yield transition(subject, state, command)
    if not _stays(subject):
        yield unsupported("states/quick stop active", f"605A takes none of {STAYING}")
        return
    for command in COMMANDS:
        subject.go(cia402.ENABLED)
        subject.command(cia402.QUICK_STOP)
        subject.reach((cia402.QUICK_STOP_ACTIVE,))
        yield transition(subject, cia402.QUICK_STOP_ACTIVE, command)


def _stays(subject: Subject) -> bool:
    """Tells the drive to stay in quick stop active, if it can."""
    for option in STAYING:
        try:
            subject.write("quick_stop_option", option)
        except SdoError:
            continue
        return True
    return False


def transition(subject: Subject, state: str, command: str) -> Result:
    """Gives a command in a state and judges what comes of it; the figure is the time it took."""
    expected = after(state, command)
    onward = tuple(name for name in expected if name != state)
    subject.command(COMMANDS[command])
    if onward:
        found, took = subject.reach(onward, PATIENCE if state in expected else STATE_TIMEOUT)
    else:
        subject.link.pause(PATIENCE)
        found, took = subject.state(), 0.0
    check = f"states/{state}: {command}"
    note = "stays" if found == state else found
    if found not in expected:
        return told(check, False, f"{note}, {' or '.join(expected)} expected")
    return told(check, True, note) if found == state else told(check, True, note, 1e3 * took, "ms")
