"""python-can's interface "hilbed": any program that speaks python-can becomes a node on the simulated wire.

`can.Bus(interface="hilbed", channel="bench")`. Timestamps are simulated seconds. Who moves the time:

- While a bench owns the channel, the bench. `recv` returns what has arrived, or None at once; called in
  another thread than the bench's, it waits for at most `timeout` s of the wall clock.
- On a channel of one thread, who receives: `recv(timeout)` goes on to the next frame that passes the filters
  or by the timeout, at once; without a timeout it returns None where nothing will ever come. Iteration
  ends there as well.
- As long as another thread uses the channel (that of a Notifier, say), the wall clock: a frame takes its
  time, and `recv` waits in real time as on any other interface.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from can import BusABC, BusState, CanInitializationError, CanOperationError, Message

from hilbed.can import channels, live
from hilbed.can.cyclic import CyclicTask, Line, frame_of
from hilbed.can.error_state import ACTIVE, PASSIVE
from hilbed.can.frame_length import frame_bits
from hilbed.clock import SECOND, nanos
from hilbed.types import BusError, Frame, Nanos

_HEARD, _SENT, _CUT_OFF = range(3)
_STATES = {ACTIVE: BusState.ACTIVE, PASSIVE: BusState.PASSIVE}


class HilbedBus(BusABC):
    """One node on a channel of this process.

    receive_own_messages: its own frames come back to it once they are through, with is_rx False.
    error_frames: the error frames on the wire are received as well. auto_restart: it comes back by itself
    after bus-off; else `state = BusState.ACTIVE` asks for it.
    """

    def __init__(
        self,
        channel: Any = "bench",
        can_filters: Any = None,
        bitrate: Any = None,
        receive_own_messages: bool = False,
        error_frames: bool = False,
        auto_restart: bool = True,
        **options: Any,
    ) -> None:
        if options.get("fd"):
            raise CanInitializationError("interface hilbed speaks classical CAN only, not CAN FD")
        self._name = str(channel)
        self._arrived: deque[tuple[Nanos, Frame, int]] = deque()
        self._tasks: list[CyclicTask] = []
        self._own = receive_own_messages
        try:
            rate = None if bitrate is None else int(bitrate)
            self._shared, self._port = channels.join(self._name, rate, self._heard)
        except (BusError, ValueError) as error:
            raise CanInitializationError(str(error)) from error
        self._shared.buses.add(self)
        self._line = Line(self._shared, self._port)
        self._port.recovers = auto_restart
        self._on_error = self._cut_off if error_frames else None
        self._line.do(self._listen)
        self.channel_info = f"hilbed {self._name}, {self._shared.wire.bitrate} bit/s, simulated time"
        super().__init__(channel=channel, can_filters=can_filters)

    def send(self, msg: Message, timeout: float | None = None) -> None:  # noqa: ARG002  (never waits)
        """Queues a classical data or remote frame at the channel's present time.

        CanOperationError where it is none, or the node is bus-off.
        """
        self._check_open()
        if msg.is_fd or msg.is_error_frame:
            raise CanOperationError("interface hilbed sends classical data and remote frames only")
        frame, channel, port = frame_of(msg), self._shared, self._port
        if port.errors.absent:
            raise CanOperationError(f"the node on channel {self._name!r} is {port.errors.absent}")
        try:
            if channel.elsewhere:
                frame_bits(frame)
                channel.wire.later(lambda: port.send(channel.wire.now, frame))
                return
            with channel.lock:
                if channel.bench is None and not channel.solo and (clock := live.of(channel)) is not None:
                    clock.catch_up()
                port.send(channel.wire.now, frame)
                channel.tell()
        except BusError as error:
            raise CanOperationError(str(error)) from error

    def recv(self, timeout: float | None = None) -> Message | None:
        """Returns the next frame that passes the filters; None, and what `timeout` (s) is, as told above."""
        self._check_open()
        message = self._next()
        if message is not None:
            return message
        channel = self._shared
        with channel.lock:
            if channel.bench is None:
                alone = channel.solo or live.of(channel) is None
                return self._recv_alone(timeout) if alone else self._recv_waiting(timeout)
            return self._recv_waiting(timeout) if channel.elsewhere else None

    def __iter__(self) -> Iterator[Message]:
        """Yields frames until nothing is under way."""
        while (message := self.recv()) is not None:
            yield message

    def flush_tx_buffer(self) -> None:
        """Takes back what is queued and not on the wire yet."""
        self._line.do(self._port.empty)

    @property
    def state(self) -> BusState:
        """ACTIVE or PASSIVE as the error counters say; ERROR: bus-off."""
        return _STATES.get(self._port.errors.state, BusState.ERROR)

    @state.setter
    def state(self, new_state: BusState) -> None:
        """Asks for the way back from bus-off: 128 times 11 recessive bits."""
        if new_state is not BusState.ACTIVE:
            raise NotImplementedError("a node becomes passive or bus-off by errors only")
        self._line.do(lambda: self._port.recover(self._shared.wire.now))

    def shutdown(self) -> None:
        """Leaves the channel; may be called again."""
        if not self._is_shutdown:
            self.stop_all_periodic_tasks()
            for task in self._tasks:  # python-can forgets those that were stopped once
                task.stop()
            channels.leave(self._name, self._shared, self._port)
        super().shutdown()

    def _recv_alone(self, timeout: float | None) -> Message | None:
        """Moves simulated time on."""
        wire = self._shared.wire
        until = None if timeout is None else wire.now + nanos(max(timeout, 0.0))
        while (message := self._next()) is None:
            if not wire.pending and live.of(self._shared) is not None:  # a Notifier, which has just begun
                return self._recv_waiting(timeout)
            if until is None:
                if wire.silent:
                    return None
                wire.step(wire.now + SECOND)
            elif not wire.step(until):
                return None
        return message

    def _recv_waiting(self, timeout: float | None) -> Message | None:
        """Waits in real time; `changed` is held, and given away meanwhile."""
        channel = self._shared
        deadline = None if timeout is None else time.monotonic() + timeout
        while True:
            clock = None if channel.bench is not None else live.of(channel)
            if clock is not None:
                clock.catch_up()
            elif channel.bench is None:  # the other thread has ended
                return self._recv_alone(timeout)
            message = self._next()
            if message is not None:
                return message
            if not (clock.wait(deadline) if clock is not None else live.wait(channel, deadline)):
                return None
            self._check_open()

    def _send_periodic_internal(
        self,
        msgs: Sequence[Message] | Message,
        period: float,
        duration: float | None = None,
        autostart: bool = True,
        modifier_callback: Callable[[Message], None] | None = None,
    ) -> CyclicTask:
        task = CyclicTask(self._line, msgs, period, duration, modifier_callback)
        self._tasks.append(task)
        self._line.do(self._listen)
        if autostart:
            task.start()
        return task

    def _listen(self) -> None:
        """Has the port told what the bus or one of its tasks wants to know."""
        wanted = self._own or self._tasks
        self._port.listen(self._sent if wanted else None, self._on_error)

    def _heard(self, t: Nanos, frame: Frame) -> None:
        self._arrived.append((t, frame, _HEARD))
        if self._shared.waiting:
            self._shared.tell()

    def _sent(self, t: Nanos, frame: Frame) -> None:
        for task in self._tasks:
            task.sent(t, frame)
        if self._own:
            self._arrived.append((t, frame, _SENT))
            self._shared.tell()

    def _cut_off(self, t: Nanos, frame: Frame) -> None:
        self._arrived.append((t, frame, _CUT_OFF))
        self._shared.tell()

    def _check_open(self) -> None:
        if self._is_shutdown:
            raise CanOperationError(f"the bus on channel {self._name!r} is shut down")

    def _next(self) -> Message | None:
        """Returns what has arrived and passes the filters."""
        arrived = self._arrived
        while arrived:
            message = self._message(*arrived.popleft())
            if self._filters is None or self._matches_filters(message):
                return message
        return None

    def _message(self, t: Nanos, frame: Frame, kind: int) -> Message:
        identifier, data, extended, remote = frame
        if kind == _CUT_OFF:
            return Message(t * 1e-9, is_error_frame=True, dlc=8, data=bytes(8), channel=self._name)
        return Message(
            t * 1e-9, identifier, extended, remote, False, self._name, len(data), data, is_rx=kind == _HEARD
        )

    @staticmethod
    def _detect_available_configs() -> list[Any]:
        return [{"interface": "hilbed", "channel": name} for name in channels.names()]
