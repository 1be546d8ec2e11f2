"""`send_periodic` in the channel's own time, without a thread: a frame that is through queues the next."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from can import LimitedDurationCyclicSendTaskABC, Message, ModifiableCyclicTaskABC, RestartableCyclicTaskABC

from hilbed.can.channels import Channel
from hilbed.can.port import Port
from hilbed.clock import nanos
from hilbed.types import Frame, Nanos


def frame_of(message: Message) -> Frame:
    """Returns a message of python-can as a frame; a remote frame has as many zeros as it asks for bytes."""
    data = bytes(message.dlc) if message.is_remote_frame else bytes(message.data)
    return Frame(message.arbitration_id, data, message.is_extended_id, message.is_remote_frame)


class Line:
    """A port on a channel, for those who may be in any thread."""

    def __init__(self, channel: Channel, port: Port) -> None:
        self.channel = channel
        self.port = port

    def do(self, act: Callable[[], object]) -> None:
        """Does something with the port: now, or at once when the bench moves its wire next."""
        if self.channel.elsewhere:
            self.channel.wire.later(act)
            return
        with self.channel.changed:
            act()
            self.channel.changed.notify_all()


class CyclicTask(LimitedDurationCyclicSendTaskABC, ModifiableCyclicTaskABC, RestartableCyclicTaskABC):
    """Sends messages one after the other, every `period` s of the channel's time, for `duration` s at most.

    A frame that has to wait for the bus delays the next one only if it is not through by then.
    """

    def __init__(
        self,
        line: Line,
        messages: Message | Sequence[Message],
        period: float,
        duration: float | None = None,
        modify: Callable[[Message], None] | None = None,
    ) -> None:
        super().__init__(messages, period, duration)
        if not self.period_ns > 0:
            raise ValueError(f"a period of {period} s; it must be at least a nanosecond")
        self._line = line
        self._modify = modify
        self._frame: Frame | None = None  # the one that is under way
        self._place = 0
        self._due: Nanos = 0
        self._end: Nanos | None = None

    def start(self) -> None:
        """Begins with the first message, unless it is running."""
        self._line.do(self._begin)

    def stop(self) -> None:
        """Ends; a message that is not on the bus yet is not sent."""
        self._line.do(self._halt)

    def modify_data(self, messages: Message | Sequence[Message]) -> None:
        """Changes the messages; the next one to be sent is new already."""
        super().modify_data(messages)
        self._line.do(self._renew)

    def sent(self, t: Nanos, frame: Frame) -> None:
        """A frame of the port is through: if it is the task's, the next one is queued."""
        if frame is not self._frame:
            return
        self._frame = None
        due = max(self._due + self.period_ns, t)
        if self._end is None or due < self._end:
            self._place = (self._place + 1) % len(self.messages)
            self._queue(due)

    def _begin(self) -> None:
        if self._frame is None:
            now = self._line.channel.wire.now
            self._end = None if self.duration is None else now + nanos(self.duration)
            self._place = 0
            self._queue(now)

    def _halt(self) -> None:
        if self._frame is not None:
            self._line.channel.wire.withdraw(self._line.port, self._frame)
        self._frame = None

    def _renew(self) -> None:
        if self._frame is not None and self._line.channel.wire.withdraw(self._line.port, self._frame):
            self._queue(self._due)

    def _queue(self, t: Nanos) -> None:
        message = self.messages[self._place]
        if self._modify is not None:
            self._modify(message)
        self._due = t
        self._frame = frame_of(message)
        self._line.port.send(t, self._frame)
