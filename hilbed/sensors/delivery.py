"""From exposure to the controller: sample rate, latency and loss, the same for every sensor."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from typing import Annotated

from pydantic import Field

from hilbed.clock import SECOND, nanos
from hilbed.spec import Fraction, NonNegative, Spec
from hilbed.types import Nanos, Reading, Rng


class DeliverySpec(Spec):
    """How a sensor's samples come to the controller.

    rate: samples a second, above 0 and at most 1000 Hz; first: s, when the first one is taken; latency: s
    from exposure to delivery, at most 10; loss: probability that a whole sample never arrives.
    """

    rate: Annotated[float, Field(gt=0, le=1000)] = 10.0
    first: NonNegative = 0.0
    latency: Annotated[NonNegative, Field(le=10)] = 0.05
    loss: Fraction = 0.0


class Delivery:
    """The clock of one sensor and the readings that are on their way; `due`: when to take the next sample."""

    def __init__(self, spec: DeliverySpec, rng: Rng) -> None:
        self._rate, self._latency, self._loss = spec.rate, nanos(spec.latency), spec.loss
        self._rng = rng
        self._count = 0
        self._first = nanos(spec.first)
        self.due: Nanos = self._first
        self._waiting: deque[Reading] = deque()

    def expose(self, t: Nanos) -> Nanos:
        """Notes a sample taken at t, makes the next one due, and returns when this one is delivered."""
        while self.due <= t:
            self._count += 1
            self.due = self._first + round(self._count * SECOND / self._rate)
        return t + self._latency

    def put(self, readings: Iterable[Reading]) -> bool:
        """Sends the readings of one sample on their way and returns whether they will arrive."""
        if self._loss and self._rng.random() < self._loss:
            return False
        self._waiting.extend(readings)
        return True

    def read(self, t: Nanos) -> list[Reading]:
        """Returns what has been delivered up to and including t since the last call, oldest first."""
        waiting, arrived = self._waiting, []
        while waiting and waiting[0].delivered <= t:
            arrived.append(waiting.popleft())
        return arrived
