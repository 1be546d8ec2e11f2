"""Threads between the bench and drivers that may make their caller wait."""

from __future__ import annotations

import errno
from contextlib import suppress
from queue import Empty, SimpleQueue
from threading import Thread
from time import monotonic, sleep

import can

from hilbed.can.driver import number_of, reason

MOST_WAITING = 256
TOO_OLD = 0.1
"""s; a command that has waited longer is too old to be sent."""
BROKEN_LINE = (ValueError, LookupError)
"""What drivers of serial adapters raise at a line that they cannot make out."""
_TURN = 0.1  # s, after which a thread looks whether it should end


class Sender:
    """Hands messages to a driver in their order; `trouble` says why it no longer does.

    patience: s that `put` waits for a driver that is slow, 0 where it must not wait.
    """

    def __init__(self, bus: can.BusABC, patience: float) -> None:
        self.trouble = ""
        self._bus = bus
        self._patience = patience
        self._too_old = max(patience, TOO_OLD)
        self._waiting: SimpleQueue[tuple[float, can.Message] | None] = SimpleQueue()
        self._put = self._dropped = 0  # by whoever calls
        self._done = 0  # by the thread
        self._since: float | None = None  # when the driver was given the message that it is sending
        self._thread = Thread(target=self._run, name="hilbed CAN sender", daemon=True)
        self._thread.start()

    @property
    def pending(self) -> int:
        """Messages that the driver has not taken yet."""
        return self._put - self._dropped - self._done

    def put(self, message: can.Message) -> str:
        """Queues a message; returns what is wrong, if it cannot be."""
        deadline = monotonic() + self._patience
        while self._full() and not self.trouble and monotonic() < deadline:
            self._thread.join(0.0005)
        if self._full():
            self.trouble = self.trouble or f"{self.pending} frames wait for a driver that takes none"
        if not self.trouble:
            self._put += 1
            self._waiting.put((monotonic(), message))
        return self.trouble

    def purge(self) -> None:
        """Drops what waits and tries again, whatever has been."""
        with suppress(Empty):
            while True:
                self._waiting.get_nowait()
                self._dropped += 1
        self.trouble = ""

    def flush(self, timeout: float) -> None:
        """Waits until the driver has taken everything, or for `timeout` s."""
        deadline = monotonic() + timeout
        while self.pending and not self.trouble and monotonic() < deadline:
            self._thread.join(0.001)

    def close(self) -> None:
        """Ends the thread, unless the driver does not let go of it."""
        self._waiting.put(None)
        self._thread.join(TOO_OLD)

    def _full(self) -> bool:
        since = self._since
        stuck = since is not None and monotonic() - since > self._too_old
        return stuck or self.pending >= MOST_WAITING

    def _run(self) -> None:
        while (waiting := self._waiting.get()) is not None:
            queued, message = waiting
            self._since = monotonic()
            if not self.trouble:
                self.trouble = self._send(queued, message)
            self._since = None
            self._done += 1

    def _send(self, queued: float, message: can.Message) -> str:
        if monotonic() - queued > self._too_old:
            return f"a frame has waited for more than {self._too_old:g} s"
        return attempt(self._bus, message, self._too_old)


def attempt(bus: can.BusABC, message: can.Message, timeout: float) -> str:
    """Sends a message, waiting for room for at most `timeout` s; returns what has gone wrong."""
    deadline = monotonic() + timeout
    while True:
        try:
            bus.send(message, timeout=timeout)
            return ""
        except Exception as error:  # a driver may raise anything
            if number_of(error) != errno.ENOBUFS or monotonic() > deadline:
                return reason(error)
        sleep(0.0005)


class Receiver:
    """Receives from a driver whose `recv` may wait, or that cannot be polled; `trouble` says why it ended."""

    def __init__(self, bus: can.BusABC) -> None:
        self.trouble = ""
        self._bus = bus
        self._arrived: SimpleQueue[can.Message | Exception | None] = SimpleQueue()
        self._open = True
        self._thread = Thread(target=self._run, name="hilbed CAN receiver", daemon=True)
        self._thread.start()

    def take(self, timeout: float) -> can.Message | None:
        """Returns the next message, None after `timeout` s without one; raises what the driver has raised."""
        message: can.Message | Exception | None = None
        with suppress(Empty):
            message = self._arrived.get(timeout=timeout) if timeout > 0.0 else self._arrived.get_nowait()
        if message is None and self.trouble:
            raise can.CanOperationError(self.trouble)
        if isinstance(message, Exception):
            raise message
        return message

    def close(self) -> None:
        self._open = False
        self._thread.join(2 * _TURN)

    def _run(self) -> None:
        while self._open:
            try:
                message = self._bus.recv(_TURN)
            except BROKEN_LINE as error:
                self._arrived.put(error)
                continue
            except Exception as error:
                self.trouble = reason(error)
                self._arrived.put(None)  # whoever waits is to hear of it
                return
            if message is not None:
                self._arrived.put(message)
