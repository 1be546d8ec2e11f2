"""A python-can bus under the wall clock, with the interface of a bus on the bench."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from time import monotonic_ns

from hilbed.can.hardware import Adapter
from hilbed.types import Frame, Nanos, Received


class LiveBus:
    """`ports.Bus` over an adapter; `pump` lets time pass until a frame comes, `step` s at most."""

    def __init__(self, adapter: Adapter, step: float = 0.01) -> None:
        self.adapter = adapter
        self._step = step
        self._start = monotonic_ns()
        self._arrived: list[Received] = []

    @property
    def now(self) -> Nanos:
        """Time since the bus was opened."""
        return monotonic_ns() - self._start

    def send(self, t: Nanos, frame: Frame) -> None:  # noqa: ARG002
        """Sends a frame at once; BusError where the bus is lost."""
        self.adapter.send(frame)

    def recv(self, t: Nanos) -> list[Received]:  # noqa: ARG002
        """Returns what has arrived since the last call."""
        arrived, self._arrived = self._arrived, []
        return arrived

    def pump(self, t: Nanos) -> Nanos:  # noqa: ARG002
        """Waits for frames and returns the time then."""
        frames = self.adapter.wait(self._step)
        now = self.now
        self._arrived += [Received(now, frame) for frame in frames]
        return now


@contextmanager
def open_bus(
    interface: str | None, channel: str | None, bitrate: int | None, step: float = 0.01
) -> Iterator[LiveBus]:
    """Opens a python-can bus and closes it in the end; ScenarioError where it cannot be opened."""
    adapter = Adapter(interface, channel, bitrate)
    try:
        yield LiveBus(adapter, step)
    finally:
        adapter.close()
