"""python-can's interface "hilbed": any program that speaks python-can becomes a node on the simulated wire.

`can.Bus(interface="hilbed", channel="bench")`. Timestamps are simulated seconds. Not for threads: use
`recv`, neither a Notifier nor `send_periodic`, which live on the wall clock.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from typing import Any

from can import BusABC, CanInitializationError, CanOperationError, Message

from hilbed.can import channels
from hilbed.clock import nanos, seconds
from hilbed.types import BusError, Frame, Nanos, Received

_FOREVER: Nanos = 1 << 62


class HilbedBus(BusABC):
    """One node on a channel of this process.

    While a bench owns the channel, `recv` returns what has arrived, or None. Otherwise `recv(timeout)`
    moves simulated time on to the next frame that passes the filters, or by the timeout; without a timeout
    it returns None where nothing is under way, for nothing would ever come. Iteration ends there as well.
    """

    def __init__(
        self, channel: Any = "bench", can_filters: Any = None, bitrate: Any = None, **options: Any
    ) -> None:
        if options.get("fd"):
            raise CanInitializationError("interface hilbed speaks classical CAN only, not CAN FD")
        if options.get("receive_own_messages"):
            raise CanInitializationError("interface hilbed does not return a bus its own frames")
        self._name = str(channel)
        try:
            self._shared, self._port = channels.join(self._name, None if bitrate is None else int(bitrate))
        except (BusError, ValueError) as error:
            raise CanInitializationError(str(error)) from error
        self._arrived: deque[Received] = deque()
        self.channel_info = f"hilbed {self._name}, {self._shared.wire.bitrate} bit/s, simulated time"
        super().__init__(channel=channel, can_filters=can_filters)

    def send(self, msg: Message, timeout: float | None = None) -> None:  # noqa: ARG002  (never waits)
        """Queues a classical data or remote frame at the channel's present time."""
        self._check_open()
        if msg.is_fd or msg.is_error_frame:
            raise CanOperationError("interface hilbed sends classical data and remote frames only")
        data = bytes(msg.dlc) if msg.is_remote_frame else bytes(msg.data)
        frame = Frame(msg.arbitration_id, data, msg.is_extended_id, msg.is_remote_frame)
        try:
            self._port.send(self._shared.wire.now, frame)
        except BusError as error:
            raise CanOperationError(str(error)) from error

    def recv(self, timeout: float | None = None) -> Message | None:
        """Returns the next frame that passes the filters; None as the class says. `timeout`: simulated s."""
        self._check_open()
        wire = self._shared.wire
        until = _FOREVER if timeout is None else wire.now + nanos(max(timeout, 0.0))
        while True:
            message = self._next()
            if message is not None:
                return message
            if self._shared.lent or (timeout is None and not wire.pending):
                return None
            if not wire.step(until):
                return None

    def __iter__(self) -> Iterator[Message]:
        """Yields frames until nothing is under way."""
        while (message := self.recv()) is not None:
            yield message

    def shutdown(self) -> None:
        """Leaves the channel; may be called again."""
        if not self._is_shutdown:
            channels.leave(self._name, self._shared, self._port)
        super().shutdown()

    def _check_open(self) -> None:
        if self._is_shutdown:
            raise CanOperationError(f"the bus on channel {self._name!r} is shut down")

    def _next(self) -> Message | None:
        """Returns what has arrived and passes the filters."""
        arrived = self._arrived
        arrived.extend(self._port.recv(self._shared.wire.now))
        while arrived:
            message = self._message(arrived.popleft())
            if self._matches_filters(message):
                return message
        return None

    def _message(self, received: Received) -> Message:
        frame = received.frame
        return Message(
            timestamp=seconds(received.t),
            arbitration_id=frame.id,
            is_extended_id=frame.extended,
            is_remote_frame=frame.remote,
            dlc=len(frame.data),
            data=None if frame.remote else frame.data,
            channel=self._name,
        )

    @staticmethod
    def _detect_available_configs() -> list[Any]:
        return [{"interface": "hilbed", "channel": name} for name in channels.names()]
