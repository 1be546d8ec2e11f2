"""A drive that is told a position: its home, where it arrives, and the limits of place and speed."""

from __future__ import annotations

from collections.abc import Iterator

from hilbed.can import cia402, nmt
from hilbed.can.sdo import SdoError
from hilbed.clock import MILLISECOND, seconds
from hilbed.conformance.result import Result, judged, told, unsupported
from hilbed.conformance.subject import SET_POINT, Subject
from hilbed.types import Nanos

SHORT = 0.2
"""s, of the way that is made: it is as long as the speed's."""
NEAR = 0.01
"""rad, within which an axis has arrived."""
PATIENCE: Nanos = 5000 * MILLISECOND
LIMITED, REACHED, ACKNOWLEDGED = 0x0800, 0x0400, 0x1000
BITS_TIMEOUT: Nanos = 200 * MILLISECOND


def homing(subject: Subject) -> Iterator[Result]:
    """The method that the drive has been given: bit 4 begins it, bit 12 says that it is done."""
    if "homing" not in subject.node.table.modes:
        yield unsupported("homing", "the table names no such mode")
        return
    _enable(subject, "homing")
    begun = subject.link.t
    subject.command(cia402.HOME)
    homed = _shows(subject, cia402.HOMED, cia402.HOMED | cia402.NOT_HOMED, PATIENCE)
    took = seconds(subject.link.t - begun)
    subject.command(cia402.ENABLE_OPERATION)
    yield told("homing", homed, f"statusword {subject.read('statusword'):04X}", took, "s")


def arrives(speed: float, subject: Subject) -> Iterator[Result]:
    """A short way there and back: how far from its target the axis ends."""
    start = _start(subject, speed)
    for name, target in (("there", start + SHORT * speed), ("back", start)):
        subject.move(target)
        subject.link.pause(_time(speed))
        yield judged(f"position/{name}", abs(subject.angle() - target), NEAR, "rad", f"to {target:.3g} rad")


def handshake(speed: float, subject: Subject) -> Iterator[Result]:
    """In PP a rising bit 4 is acknowledged by bit 12 until it falls; bit 10 falls and comes back."""
    if subject.node.mode != "pp":
        yield unsupported("set-points", "not in PP")
        return
    start = _start(subject, speed)
    subject.put(subject.entry("target_position"), (start + SHORT * speed) * subject.node.counts_per_radian)
    subject.link.pause(_time(speed))
    yield told("set-points/not before bit 4", abs(subject.angle() - start) < NEAR)
    subject.command(SET_POINT)
    yield told("set-points/acknowledged", _shows(subject, ACKNOWLEDGED, ACKNOWLEDGED | REACHED))
    subject.command(cia402.ENABLE_OPERATION)
    yield told("set-points/released", _shows(subject, 0, ACKNOWLEDGED))
    yield told("set-points/reached", _shows(subject, REACHED, REACHED, PATIENCE))


def limits(speed: float, subject: Subject) -> Iterator[Result]:
    """607D holds an axis that is sent farther; bit 11 says so."""
    start = _start(subject, speed)
    way = 0.5 * SHORT * speed
    ends = sorted(edge * subject.node.counts_per_radian for edge in (start - way, start + way))
    try:
        for word, edge in zip(("lowest_position", "highest_position"), ends, strict=True):
            subject.write(word, edge)
    except SdoError as error:
        yield unsupported("limits/position", f"607D: abort {error.code:08X}")
        return
    subject.move(start + 4.0 * way)
    shown = _shows(subject, LIMITED, LIMITED)
    subject.link.pause(_time(speed))
    yield judged(
        "limits/position", abs(subject.angle() - start - way), NEAR, "rad", f"607D is ±{way:.3g} rad"
    )
    yield told("limits/position is told", shown, "bit 11 of the statusword")


def speed_limit(speed: float, subject: Subject) -> Iterator[Result]:
    """On a long way the axis turns as fast as 607F says, and no faster."""
    _start(subject, 0.5 * speed)
    subject.target(speed)
    subject.link.pause(500 * MILLISECOND)
    begun, position = subject.link.t, subject.read("position_actual")
    subject.link.pause(300 * MILLISECOND)
    mean = abs(subject.turned(position)) / seconds(subject.link.t - begun)
    highest = 0.5 * abs(speed)
    yield judged("limits/speed", mean, 1.05 * highest, "rad/s", f"607F is {highest:g} rad/s")


def _start(subject: Subject, speed: float) -> float:
    """Enables the drive, which is to go at a speed; returns the angle (rad) at which it stands."""
    subject.hurry(speed)
    _enable(subject, subject.node.mode)
    return subject.angle()


def _enable(subject: Subject, mode: str) -> None:
    subject.manage(nmt.START)
    subject.use_mode(mode)
    subject.target(0.0)
    subject.go(cia402.ENABLED)


def _time(speed: float) -> Nanos:
    """Returns how long the short way takes, speeding up and braking included."""
    return round((SHORT + 0.2 * abs(speed) + 0.5) * 1000) * MILLISECOND


def _shows(subject: Subject, bits: int, mask: int, timeout: Nanos = BITS_TIMEOUT) -> bool:
    """Waits until the statusword shows bits."""
    begun = subject.link.t
    while subject.read("statusword") & mask != bits:
        if subject.link.t - begun > timeout:
            return False
        subject.link.step()
    return True
