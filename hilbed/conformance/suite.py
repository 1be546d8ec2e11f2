"""All checks in their order, each on a drive at rest with its own settings."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from contextlib import suppress
from functools import partial
from typing import NamedTuple, TypeAlias

from hilbed.can import cia402, nmt
from hilbed.can.sdo import SdoError
from hilbed.can.sdo_aborts import TIMEOUT
from hilbed.clock import MILLISECOND
from hilbed.conformance.checks import (
    bus,
    faults,
    identity,
    modes,
    motion,
    pdos,
    position,
    sheet,
    states,
)
from hilbed.conformance.eds import Promise
from hilbed.conformance.result import Result
from hilbed.conformance.subject import Stuck, Subject
from hilbed.types import BusError, Nanos

LISTENING: Nanos = 1100 * MILLISECOND
"""To hear the heartbeats of everybody on the bus, which come once a second at least as a rule."""
Check: TypeAlias = Callable[[Subject], Iterable[Result]]


class Terms(NamedTuple):
    """What the checks may do: turn the motor (armed), how fast (rad/s); what the bus is.

    exact: it is the simulated wire, which takes every load; promises: entries of the drive's EDS, if given.
    """

    armed: bool
    speed: float
    bitrate: int
    exact: bool
    promises: Sequence[Promise] = ()


class Item(NamedTuple):
    """A check by its name, and whether it puts current through the motor."""

    name: str
    check: Check
    powers: bool = False


def suite(terms: Terms, positions: bool = False) -> list[Item]:
    """Returns the checks, those without power first; positions: of a drive that is told a position."""
    data_sheet = [Item("eds", partial(sheet.sheet, terms.promises))] if terms.promises else []
    return [
        Item("identity", identity.identity),
        *data_sheet,
        Item("sdo", identity.sdo),
        Item("modes", modes.modes),
        Item("pdo", pdos.remap),
        Item("sync", bus.quiet),
        Item("load", partial(bus.busy, terms.bitrate, terms.exact)),
        Item("heartbeat", faults.heartbeat),
        Item("states without power", states.unpowered),
        Item("states with power", states.powered, True),
        Item("fault", faults.fault, True),
        Item("quick stop", partial(motion.quick_stop, terms.speed), True),
        Item("abandoned", partial(faults.abandoned, terms.speed), True),
        *(_of_positions(terms.speed) if positions else _of_speeds(terms.speed)),
    ]


def _of_speeds(speed: float) -> list[Item]:
    return [
        Item("limits/speed", partial(motion.speed_limit, speed), True),
        Item("limits/acceleration", partial(motion.acceleration_limit, speed), True),
    ]


def _of_positions(speed: float) -> list[Item]:
    return [
        Item("homing", position.homing, True),
        Item("position", partial(position.arrives, speed), True),
        Item("set-points", partial(position.handshake, speed), True),
        Item("limits/position", partial(position.limits, speed), True),
        Item("limits/speed", partial(position.speed_limit, speed), True),
    ]


def perform(subject: Subject, terms: Terms) -> Generator[Result, None, None]:
    """Yields the results as they are found; leaves the drive as it was, but for being at rest.

    Raises BusError where there is no drive, where somebody drives it, or where the bus is lost.
    """
    _approach(subject)
    state = subject.heartbeats.states.get(subject.node.id)
    try:
        for item in suite(terms, subject.node.table.positions):
            if item.powers and not terms.armed:
                yield Result(item.name, "not run", note="puts current through the motor: --arm")
                continue
            yield from _guarded(item, subject)
    finally:
        with suppress(BusError):
            subject.settle()
            subject.manage(nmt.START if state == nmt.OPERATIONAL else nmt.ENTER_PREOPERATIONAL)


def _approach(subject: Subject) -> None:
    """Looks whether there is a drive that nobody drives."""
    try:
        subject.sdo.upload(0x1000, 0)
    except SdoError as error:
        if error.code != TIMEOUT:
            raise
        raise BusError(
            f"nobody answers as node {subject.node.id}: is the drive powered and wired, with this number and "
            "the bus's bit rate? `hilbed bus scan` lists who is there"
        ) from None
    state = subject.state()
    if state in (cia402.ENABLED, cia402.QUICK_STOP_ACTIVE):
        raise BusError(f"{subject.node} is in {state}: somebody drives it; switch it off first")
    subject.link.pause(LISTENING)


def _guarded(item: Item, subject: Subject) -> Iterator[Result]:
    try:
        yield from item.check(subject)
    except (SdoError, Stuck) as error:
        yield Result(item.name, "fail", note=str(error))
        if isinstance(error, SdoError) and error.code == TIMEOUT:
            subject.sdo.upload(0x1000, 0)  # raises where the drive is gone
    refused = subject.settle()
    if refused:
        yield Result(f"{item.name}/settings given back", "fail", note="; ".join(refused))
