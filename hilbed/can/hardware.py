"""Any python-can bus as the bench sees it: sending and polling never wait, whatever the driver does."""

from __future__ import annotations

import select
from collections.abc import Callable
from time import monotonic

import can

from hilbed.can.counts import Counts
from hilbed.can.driver import frame_of, message, open_driver, reason
from hilbed.can.driver_threads import BROKEN_LINE, Receiver, Sender, attempt
from hilbed.types import BusError, Frame

MOST = 256
"""As many frames one poll returns; the others come with the next one."""
PROMPT = ("socketcan", "virtual", "udp_multicast")
"""Interfaces whose driver never makes the caller of `send` wait."""

_BUS_OFF = 0x40  # class of error in the identifier of SocketCAN's error frames
_BUS_OFF_WORDS = "the adapter is bus-off: is a node on the bus to acknowledge, with this bit rate?"
Receive = Callable[[float], "can.Message | None"]


class Adapter:
    """One end of a python-can bus.

    interface, channel, bitrate: None is left to python-can (CAN_INTERFACE …, ~/.canrc). ScenarioError where
    it cannot be opened. name: for messages. Where the bus is lost, `send`, `poll` and `wait` raise BusError.
    patience: s that `send` may wait for a slow driver, as in lockstep, where simulated time waits with it.
    """

    def __init__(
        self,
        interface: str | None,
        channel: str | int | None = None,
        bitrate: int | None = None,
        patience: float = 0.0,
    ) -> None:
        self._driver = open_driver(interface, channel, bitrate)
        self.name = str(self._driver.names)
        self.counts = Counts()
        self._patience = patience
        self._sender = None if self._driver.names.interface in PROMPT else Sender(self._driver.bus, patience)
        self._receiver: Receiver | None = None
        self._next = self._choose()

    def send(self, frame: Frame) -> None:
        """Sends a frame now, or drops it and raises BusError: it is never sent late."""
        sending = message(frame)
        if self._sender is not None:
            trouble = self._sender.put(sending)
        else:
            trouble = attempt(self._driver.bus, sending, self._patience)
        if trouble:
            self.counts.dropped += 1
            raise self._lost("sending", trouble)
        self.counts.sent += 1

    def poll(self) -> list[Frame]:
        """Returns what has arrived, at most `MOST` frames, without waiting."""
        frames: list[Frame] = []
        for _ in range(MOST):
            if not self._receive(0.0, frames):
                break
        return frames

    def wait(self, timeout: float) -> list[Frame]:
        """Returns what has arrived as soon as that is anything; nothing after `timeout` s."""
        deadline = monotonic() + timeout
        frames: list[Frame] = []
        while not frames and (left := deadline - monotonic()) > 0.0:
            self._receive(left, frames)
        return frames + self.poll()

    def purge(self) -> None:
        """Drops what waits to be sent: before a stop, which must not stand in line behind old commands."""
        if self._sender is not None:
            self._sender.purge()

    def close(self, timeout: float = 0.1) -> None:
        """Gives the driver `timeout` s to send what it has been given, then closes it."""
        if self._sender is not None:
            self._sender.flush(timeout)
            self._sender.close()
        if self._receiver is not None:
            self._receiver.close()
        try:
            self._driver.bus.shutdown()
        except Exception:  # a bus that is gone cannot be closed, and that has been told
            self._driver.bus._is_shutdown = True

    def _receive(self, timeout: float, frames: list[Frame]) -> bool:
        """Adds the next message, if it is a frame; returns whether there was one."""
        try:
            received = self._next(timeout)
        except BROKEN_LINE:
            self.counts.malformed += 1
            return True
        except Exception as error:  # a driver may raise anything
            raise self._lost("receiving", reason(error)) from None
        if received is None:
            return False
        self._sort(received, frames)
        return True

    def _sort(self, received: can.Message, frames: list[Frame]) -> None:
        if received.is_error_frame:
            self.counts.errors += 1
            if received.arbitration_id & _BUS_OFF or self._driver.bus.state is can.BusState.ERROR:
                raise self._lost("receiving", _BUS_OFF_WORDS)
        elif not received.is_rx and self._driver.names.interface != "socketcan":
            return  # an own frame, which some drivers return; SocketCAN marks all that this machine sends
        elif (frame := frame_of(received)) is None:
            self.counts.malformed += 1
        else:
            self.counts.received += 1
            frames.append(frame)

    def _lost(self, doing: str, why: str) -> BusError:
        return BusError(f"{self.name}: lost while {doing}: {why}")

    def _choose(self) -> Receive:
        """Returns how the driver is asked for its next message: polled, directly, or by a thread."""
        bus = self._driver.bus
        try:
            number = bus.fileno()
        except Exception:  # it has none
            number = -1
        if number >= 0:
            return _polled(bus, number)
        if self._driver.names.interface in PROMPT:
            return bus.recv
        self._receiver = Receiver(bus)
        return self._receiver.take


def _polled(bus: can.BusABC, number: int) -> Receive:
    """Asks a driver with a file descriptor only if there is something: some wait in vain else."""
    poller = select.poll()
    poller.register(number, select.POLLIN)

    def receive(timeout: float) -> can.Message | None:
        milliseconds = 1e3 * timeout
        for _ in range(MOST):  # what a serial adapter acknowledges is no message
            if not poller.poll(milliseconds):
                break
            received = bus.recv(0.0)
            if received is not None:
                return received
            milliseconds = 0.0
        return None

    return receive
