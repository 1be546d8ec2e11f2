"""Every way onto a bus, behind `ports.Bus`, on a wire whose time the test moves."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import NamedTuple

import can

from hilbed.can import channels
from hilbed.can.wire import Wire
from hilbed.ports import Bus
from hilbed.types import BusError, Frame, Nanos, Received


class Medium(NamedTuple):
    """Nodes on one wire and what moves its time to t (ns)."""

    nodes: list[Bus]
    advance: Callable[[Nanos], None]


class PythonCan:
    """The python-can interface "hilbed", as a Bus."""

    def __init__(self, bus: can.BusABC) -> None:
        self._bus = bus

    def send(self, t: Nanos, frame: Frame) -> None:  # noqa: ARG002  (python-can sends now)
        try:
            message = can.Message(
                arbitration_id=frame.id,
                is_extended_id=frame.extended,
                is_remote_frame=frame.remote,
                dlc=len(frame.data),
                data=None if frame.remote else frame.data,
            )
            self._bus.send(message)
        except (can.CanError, ValueError) as error:
            raise BusError(str(error)) from error

    def recv(self, t: Nanos) -> list[Received]:  # noqa: ARG002  (python-can receives now)
        received = []
        while (message := self._bus.recv(0)) is not None:
            data = bytes(message.dlc) if message.is_remote_frame else bytes(message.data)
            frame = Frame(message.arbitration_id, data, message.is_extended_id, message.is_remote_frame)
            received.append(Received(round(message.timestamp * 1e9), frame))
        return received


@contextmanager
def wire(count: int) -> Iterator[Medium]:
    """Ports of the simulated wire."""
    medium = Wire(500_000)
    medium.advance(0)
    yield Medium([medium.attach(f"node {k}") for k in range(count)], medium.advance)


@contextmanager
def python_can(count: int) -> Iterator[Medium]:
    """Python-can buses on a wire that is lent to them."""
    medium = Wire(500_000)
    medium.advance(0)
    with ExitStack() as open_buses:
        open_buses.enter_context(channels.lend("contract", medium))
        nodes: list[Bus] = []
        for _ in range(count):
            bus = can.Bus(interface="hilbed", channel="contract")
            open_buses.callback(bus.shutdown)
            nodes.append(PythonCan(bus))
        yield Medium(nodes, medium.advance)


MEDIA = {"wire": wire, "python-can": python_can}
