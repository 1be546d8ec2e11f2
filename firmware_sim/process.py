"""The bus of a firmware that is a process of its own: all that the firmware knows of python-can."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from select import select
from typing import Any, NoReturn

import can

from firmware_sim.frame import Frame
from firmware_sim.terminal import TO_FIRMWARE, Terminal

SEND_TIMEOUT = 0.5
"""s; a bus that takes no frame for so long is lost."""


class NoBus(Exception):
    """The bus cannot be opened."""


class BusLost(Exception):
    """The bus was there and has gone."""


@contextmanager
def open_bus(
    interface: str | None, channel: str | None, bitrate: int | None, node: int
) -> Iterator[can.BusABC]:
    """Opens a bus as python-can resolves it (argument, environment, ~/.canrc); NoBus where it is not there.

    Of extended frames only the node's terminal frames are let in.
    """
    wanted: dict[str, Any] = {"interface": interface, "channel": channel, "bitrate": bitrate}
    given = {key: value for key, value in wanted.items() if value is not None}
    filters: list[dict[str, Any]] = [
        {"can_id": 0, "can_mask": 0, "extended": False},
        {"can_id": TO_FIRMWARE + node, "can_mask": 0x1FFFFFFF, "extended": True},
    ]
    try:
        bus = can.Bus(**given, can_filters=filters)
    except (can.CanError, OSError, ValueError, ImportError) as error:
        raise NoBus(f"no bus on interface {interface} channel {channel}: {error}") from error
    try:
        yield bus
    finally:
        _close(bus)


def _close(bus: can.BusABC) -> None:
    with suppress(can.CanError, OSError):  # it may have gone already
        bus.shutdown()


def serve(bus: can.BusABC, terminal: Terminal, pins: can.BusABC | None = None) -> NoReturn:
    """Hands every frame to the drive and sends what it answers, for good; BusLost when a bus goes away.

    pins: the bus of terminal frames, if they have one of their own; then `bus` is looked at once a tick.
    """
    first = bus if pins is None else pins
    try:
        while True:
            message = first.recv()
            while pins is not None and _waiting(bus) and (heard := bus.recv(0.0)) is not None:
                _take(heard, terminal)
            for frame in _take(message, terminal):
                (first if frame.extended else bus).send(as_message(frame), SEND_TIMEOUT)
    except (can.CanError, OSError) as error:
        raise BusLost(str(error)) from error


def _waiting(bus: can.BusABC) -> bool:
    """Tells whether it is worth to ask a bus: some drivers wait for a frame even if they are told not to."""
    try:
        number = bus.fileno()
    except NotImplementedError:
        return True
    return number < 0 or bool(select([number], [], [], 0.0)[0])


def _take(message: can.Message | None, terminal: Terminal) -> list[Frame]:
    if message is None or message.is_error_frame or message.is_fd:
        return []
    return terminal.receive(as_frame(message))


def as_frame(message: can.Message) -> Frame:
    data = b"" if message.is_remote_frame else bytes(message.data)
    return Frame(message.arbitration_id, data, message.is_extended_id, message.is_remote_frame)


def as_message(frame: Frame) -> can.Message:
    return can.Message(
        arbitration_id=frame.id,
        data=frame.data,
        is_extended_id=frame.extended,
        is_remote_frame=frame.remote,
    )
