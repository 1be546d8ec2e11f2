"""Opening a python-can driver: its own resolution of names, and a clear word for everything it refuses."""

from __future__ import annotations

import errno
import logging
from typing import Any, NamedTuple

import can

from hilbed.can.socketcan import complaint
from hilbed.types import Frame, ScenarioError

logging.getLogger("can").addHandler(logging.NullHandler())  # what drivers log is told by the bench itself

_HINTS = {
    errno.ENODEV: "there is no such interface; `ip -brief link` lists those of this machine",
    errno.ENOENT: "there is no such device",
    errno.EACCES: "permission denied; is this user in the device's group?",
    errno.EPERM: "permission denied",
    errno.EBUSY: "another program has it open",
    errno.EAFNOSUPPORT: "this kernel has no CAN; scripts/vcan COMMAND runs a command where it has",
}


class Names(NamedTuple):
    """What a bus goes by; None where nobody says."""

    interface: str
    channel: str | int | None
    bitrate: int | None

    def __str__(self) -> str:
        return self.interface if self.channel is None else f"{self.interface} {self.channel}"


class Driver(NamedTuple):
    """An open bus and what it goes by."""

    bus: can.BusABC
    names: Names


def resolve(
    interface: str | None = None, channel: str | int | None = None, bitrate: int | None = None
) -> Names:
    """Returns the names of a bus; what is None comes from CAN_INTERFACE and the like, then from ~/.canrc.

    Raises ScenarioError where python-can knows no such interface, or cannot read its settings.
    """
    try:
        config = can.util.load_config(config=_given(interface, channel, bitrate))
    except Exception as error:
        raise ScenarioError(f"bus: {_unresolved(interface, error)}") from None
    return Names(str(config["interface"]), config["channel"], config.get("bitrate"))


def open_driver(interface: str | None, channel: str | int | None, bitrate: int | None) -> Driver:
    """Opens the bus that `resolve` finds; ScenarioError, with what would do, for all that drivers refuse."""
    names = resolve(interface, channel, bitrate)
    if names.interface == "socketcan":
        _check_socketcan(names)
    try:
        return Driver(can.Bus(**_given(interface, channel, bitrate)), names)
    except TypeError as error:
        if names.channel is None:  # a driver whose signature wants one
            raise ScenarioError(f"bus: {names} needs a channel: say which with -c") from None
        raise ScenarioError(f"bus: {names} cannot be opened: {reason(error)}") from None
    except Exception as error:  # a driver may raise anything
        raise ScenarioError(f"bus: {names} cannot be opened: {reason(error)}") from None


def reason(error: BaseException) -> str:
    """Returns what went wrong as one line, with a hint where the operating system's reason is known."""
    words, cause = str(error) or type(error).__name__, error.__cause__
    if cause is not None and str(cause) not in words:
        words = f"{words}: {cause}"
    hint = _HINTS.get(number_of(error) or 0)
    return " ".join(f"{words} ({hint})".split() if hint else words.split())


def number_of(error: BaseException | None) -> int | None:
    """Returns the operating system's number of an error, its own or that of what caused it."""
    while error is not None:
        number = getattr(error, "errno", None) or getattr(error, "error_code", None)
        if isinstance(number, int):
            return number
        error = error.__cause__ or error.__context__
    return None


def message(frame: Frame) -> can.Message:
    """Returns a frame as python-can has it."""
    return can.Message(
        arbitration_id=frame.id,
        is_extended_id=frame.extended,
        is_remote_frame=frame.remote,
        dlc=len(frame.data),
        data=None if frame.remote else frame.data,
    )


def frame_of(received: can.Message) -> Frame | None:
    """Returns a message as the bench has it; None if it is no CAN 2.0 frame, whatever the driver says."""
    identifier, extended, size = received.arbitration_id, received.is_extended_id, received.dlc
    if received.is_fd or not 0 <= size <= 8 or not 0 <= identifier <= (0x1FFFFFFF if extended else 0x7FF):
        return None
    if received.is_remote_frame:
        return Frame(identifier, bytes(size), extended, True)
    return Frame(identifier, bytes(received.data), extended) if len(received.data) == size else None


def _given(interface: str | None, channel: str | int | None, bitrate: int | None) -> dict[str, Any]:
    given = {"interface": interface, "channel": channel, "bitrate": bitrate}
    return {key: value for key, value in given.items() if value is not None}


def _unresolved(interface: str | None, error: Exception) -> str:
    if not isinstance(error, can.CanInterfaceNotImplementedError):
        return f"python-can's settings (CAN_CONFIG, ~/.canrc …): {reason(error)}"
    known = f"python-can knows {', '.join(sorted(can.VALID_INTERFACES))}"
    if interface is None:
        return f"no interface that python-can knows is named by -i, CAN_INTERFACE or ~/.canrc; {known}"
    return f"unknown interface {interface!r}; {known}"


def _check_socketcan(names: Names) -> None:
    """Finds what the socket would tell only later, or never: no channel, an interface down, its bit rate."""
    if not names.channel:
        raise ScenarioError("bus: socketcan needs a channel, such as -c can0")
    wrong = complaint(str(names.channel), names.bitrate)
    if wrong:
        raise ScenarioError(f"bus: {names} {wrong}")
