"""The controller's end of the bus while it waits for answers: time moves only through `pump`."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TypeVar

from hilbed.clock import seconds
from hilbed.ports import Bus
from hilbed.types import BusError, Frame, Nanos, Received

Answer = TypeVar("Answer")
Pump = Callable[[Nanos], Nanos]
"""Lets the world move on from t by a little (a simulated millisecond, a short sleep); returns the new t."""


class Link:
    """A bus, the time, and listeners that hear every frame whoever waits for what.

    limit: no wait goes beyond this time (BusError). each_step: called with t before time moves.
    """

    def __init__(self, bus: Bus, pump: Pump, t: Nanos, limit: Nanos) -> None:
        self.t = t
        self.listeners: list[Callable[[Received], None]] = []
        self.each_step: list[Callable[[Nanos], None]] = []
        self._bus = bus
        self._pump = pump
        self._limit = limit
        self._unread: deque[Frame] = deque()

    def send(self, frame: Frame) -> None:
        """Sends a frame now."""
        self._bus.send(self.t, frame)

    def forget(self) -> None:
        """Drops frames that nobody has waited for, so that an old answer is not taken for a new one."""
        self._unread.clear()

    def answer(self, accept: Callable[[Frame], Answer | None], timeout: Nanos) -> Answer | None:
        """Returns what `accept` makes of the first frame that it takes, None after `timeout`."""
        deadline = self.t + timeout
        while True:
            while self._unread:
                accepted = accept(self._unread.popleft())
                if accepted is not None:
                    return accepted
            if self.t >= deadline:
                return None
            self.step()

    def until(self, condition: Callable[[], bool], timeout: Nanos) -> bool:
        """Waits for a condition that listeners bring about; False after `timeout`."""
        deadline = self.t + timeout
        while not condition():
            if self.t >= deadline:
                return False
            self.step()
        return True

    def pause(self, length: Nanos) -> None:
        """Waits for nothing; listeners go on."""
        end = self.t + length
        while self.t < end:
            self.step()

    def step(self) -> None:
        """Moves time on once and hands out what has arrived; BusError at the limit."""
        if self.t >= self._limit:
            raise BusError(f"the drives were not ready by t = {seconds(self._limit):g} s")
        for act in self.each_step:
            act(self.t)
        self.t = self._pump(self.t)
        for received in self._bus.recv(self.t):
            self._unread.append(received.frame)
            for listen in self.listeners:
                listen(received)
