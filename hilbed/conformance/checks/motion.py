"""A wheel that turns: how it stops, and whether it keeps to its limits."""

from __future__ import annotations

from collections.abc import Iterator

from hilbed.can import cia402
from hilbed.can.sdo import SdoError
from hilbed.clock import MILLISECOND, seconds
from hilbed.conformance.motion import braking, expected_braking, rate
from hilbed.conformance.result import Result, judged, unsupported
from hilbed.conformance.subject import Subject
from hilbed.types import Nanos

REACTION = 0.1
"""s that a drive may take before it brakes, and the measurement to notice."""
MARGIN = 1.2
SETTLING: Nanos = 1000 * MILLISECOND
WINDOW: Nanos = 300 * MILLISECOND


def quick_stop(speed: float, subject: Subject) -> Iterator[Result]:
    """Time and turn from the command to standstill, against the ramp of 6085."""
    subject.run(speed)
    expected = expected_braking(subject, speed)
    subject.command(cia402.QUICK_STOP)
    found = braking(subject, speed)
    note = f"from {speed:g} rad/s"
    yield judged("quick stop/time", found.time, MARGIN * expected.time + REACTION, "s", note)
    yield judged("quick stop/turn", found.turn, MARGIN * expected.turn + REACTION * abs(speed), "rad", note)


def speed_limit(speed: float, subject: Subject) -> Iterator[Result]:
    """A target of twice the highest velocity (607F) gives no more than that."""
    highest = abs(speed) / 2
    if "max_velocity" not in subject.node.table.objects:
        yield unsupported("limits/speed", "the table names no max_velocity")
        return
    try:
        subject.write("max_velocity", abs(highest * subject.node.velocity_per_radian))
    except SdoError as error:
        yield unsupported("limits/speed", f"607F: abort {error.code:08X}")
        return
    subject.run(speed / 2 * 0.9)
    subject.target(speed)
    subject.link.pause(SETTLING)
    mean = abs(_mean_speed(subject))
    yield judged("limits/speed", mean, 1.05 * highest, "rad/s", f"607F is {highest:g} rad/s")


def acceleration_limit(speed: float, subject: Subject) -> Iterator[Result]:
    """In PV the wheel gains speed no faster than 6083 says."""
    table = subject.node.table
    if not {"pv", "pp"} & {*table.modes} or rate(subject, "acceleration") is None:
        yield unsupported("limits/acceleration", "no PV or PP, or no 6083 in counts/s²")
        return
    wanted = abs(speed) / 0.5
    subject.write("acceleration", wanted * abs(subject.node.counts_per_radian))
    subject.run(0.1 * speed)
    begun, before = subject.link.t, subject.speed()
    subject.target(speed)
    subject.until(lambda now: abs(now) > 0.8 * abs(speed), 5 * SETTLING)
    gained = abs(subject.speed() - before) / max(seconds(subject.link.t - begun), 1e-3)
    yield judged("limits/acceleration", gained, MARGIN * wanted, "rad/s²", f"6083 is {wanted:g} rad/s²")


def _mean_speed(subject: Subject) -> float:
    """Returns the mean speed, rad/s, over some time, from the way."""
    begun, position = subject.link.t, subject.read("position_actual")
    subject.link.pause(WINDOW)
    return subject.turned(position) / seconds(subject.link.t - begun)
