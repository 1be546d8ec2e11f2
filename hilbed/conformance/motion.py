"""How a wheel comes to rest: measured, and as its deceleration lets expect."""

from __future__ import annotations

from math import inf
from typing import NamedTuple

from hilbed.can.sdo import SdoError
from hilbed.clock import SECOND, seconds
from hilbed.conformance.subject import Subject
from hilbed.types import Nanos

SLOW = 0.05
"""Share of the speed below which a wheel is taken to stand."""
PATIENCE: Nanos = 5 * SECOND


class Braking(NamedTuple):
    """Time (s) and turn (rad) until standstill; infinite where the wheel goes on turning."""

    time: float
    turn: float


def braking(subject: Subject, speed: float) -> Braking:
    """Measures from now until the wheel stands that has turned at `speed` (rad/s)."""
    begun, position = subject.link.t, subject.read("position_actual")
    if not subject.until(lambda now: abs(now) < SLOW * abs(speed), PATIENCE):
        return Braking(inf, inf)
    return Braking(seconds(subject.link.t - begun), abs(subject.turned(position)))


def expected_braking(subject: Subject, speed: float) -> Braking:
    """Returns v/a and v²/2a of a ramp at the drive's quick stop deceleration, as the table has its unit.

    Where it has none, as in tables of other units than counts, a second is allowed.
    """
    deceleration = rate(subject, "quick_stop_deceleration")
    if deceleration is None:
        return Braking(1.0, abs(speed))
    return Braking(abs(speed) / deceleration, speed * speed / (2.0 * deceleration))


def rate(subject: Subject, word: str) -> float | None:
    """Reads an acceleration in rad/s² at the wheel; None where it is not there, or not in counts/s²."""
    if subject.node.table.units.velocity != "counts/s":
        return None
    try:
        value = subject.read(word)
    except SdoError:
        return None
    return value / abs(subject.node.counts_per_radian) or None
