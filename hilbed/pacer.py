"""The bench in real time: simulated time waits for the wall clock, by absolute deadlines.

Who comes too late for a deadline does not hurry to catch up with commands: the world goes on, the commands
of that cycle are not sent to a bus that others are on, and the next deadlines stay where they were.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Annotated, Literal, NamedTuple, Protocol

from pydantic import Field

from hilbed.clock import nanos, seconds
from hilbed.cost import Cost, perf_counter
from hilbed.ledger import Ledger
from hilbed.spec import Positive, Spec
from hilbed.types import HilbedError, Nanos


class RealtimeSpec(Spec):
    """Pace of a run: a second of the wall clock for each simulated one.

    overrun: of a cycle that begins late by more than `tolerance` (s, half a period by default): skip (it is
    counted, its commands are not sent to others, the schedule is kept) or fail (the run); give_up: s; a run
    that begins a cycle so late has lost real time for good and fails; boot: whole s that drives elsewhere
    have to come up.
    """

    overrun: Literal["skip", "fail"] = "skip"
    tolerance: Positive | None = None
    give_up: Positive = 1.0
    boot: Annotated[int, Field(ge=1, le=60)] = 3


class Overrun(HilbedError):
    """A cycle has begun too late and the scenario does not stand that."""


class Time(NamedTuple):
    """A clock that never goes back (ns) and a sleep (s)."""

    now: Callable[[], Nanos] = time.monotonic_ns
    sleep: Callable[[float], None] = time.sleep


class Medium(Protocol):
    """A bus in simulated time."""

    def advance(self, until: Nanos) -> None: ...


class Pacer:
    """Keeps a run with cycles of `period` ns to the wall clock and its ledger of how well that went.

    cost: of the run, whose time on the bus is not to hold the waiting.
    """

    def __init__(
        self, spec: RealtimeSpec, period: Nanos, cost: Cost | None = None, wall: Time | None = None
    ) -> None:
        self.ledger = Ledger()
        self.cost = cost or Cost()
        self.period = period
        self._tolerance = period // 2 if spec.tolerance is None else nanos(spec.tolerance)
        self._most = self._tolerance if spec.overrun == "fail" else nanos(spec.give_up)
        self._wall = wall or Time()
        self._zero: Nanos | None = None

    def start(self, t: Nanos) -> None:
        """Declares that it is `t` now."""
        self._zero = self._wall.now() - t

    def wait(self, t: Nanos) -> Nanos:
        """Waits until it is `t`; returns by how much it is later then (ns)."""
        if self._zero is None:
            self.start(t)
            return 0
        deadline = self._zero + t
        while (left := deadline - self._wall.now()) > 0:
            self._wall.sleep(left / 1e9)
        return -left

    def due(self, t: Nanos) -> bool:
        """Waits for a cycle's beginning; returns whether its commands may still be sent. Raises Overrun."""
        late = self.wait(t)
        missed = late > self._tolerance
        self.ledger.note(t, late, missed)
        if late > self._most:
            raise Overrun(f"real time lost: the cycle began {seconds(late):.4f} s late")
        return not missed


class Paced:
    """A medium whose time does not run ahead of the wall clock's.

    The beginning of a cycle is waited for by `Pacer.due`: what ends a cycle, the records, may take its time.
    """

    def __init__(self, medium: Medium, pacer: Pacer) -> None:
        self._medium = medium
        self._pacer = pacer

    def advance(self, until: Nanos) -> None:
        """Lets happen what happens by `until`, then waits for it."""
        self._medium.advance(until)
        if until % self._pacer.period:
            begun = perf_counter()
            self._pacer.wait(until)
            self._pacer.cost.bus -= perf_counter() - begun
