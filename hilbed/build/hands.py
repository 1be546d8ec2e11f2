"""What is done with a bench of drives before its first cycle and after its last."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

from hilbed.build.bench import BOOT
from hilbed.build.carriage import Carriage
from hilbed.can.base import CanBase
from hilbed.can.ears import BusEvent
from hilbed.can.faults import Faults
from hilbed.can.master import Master
from hilbed.can.wake import Waker
from hilbed.clock import SECOND, seconds
from hilbed.types import BusError, Command, Nanos

STANDSTILL: Nanos = SECOND
"""How long the bench goes on after the last cycle at most, so that the drives come to rest."""


NOT_STOPPED = f"does not say that it stands, {seconds(STANDSTILL):g} s after the quick stop"


class Plant(Protocol):
    """The far end, which can also be run with the shafts held."""

    def idle(self, start: Nanos, end: Nanos) -> None: ...

    def live(self, start: Nanos, end: Nanos) -> None: ...

    def start(self) -> None: ...

    def advance(self, start: Nanos, end: Nanos) -> None: ...


@dataclass(frozen=True)
class Hands:
    """Boots and stops a bench; tick and period in ns; flush: what is still on its way to sensors comes in.

    wake: brings up what is elsewhere, before time begins; faults: of the bus;
    searching: whether a drive looks for its home as it is booted, which moves the robot.
    """

    master: Master
    base: CanBase
    plant: Plant
    carriage: Carriage
    flush: Sequence[Callable[[], None]]
    tick: Nanos
    period: Nanos
    wake: Sequence[Waker] = ()
    faults: Faults | None = None
    power_on: Nanos = BOOT
    searching: bool = False

    def boot(self, going: Callable[[], None]) -> None:
        """Brings the drives up, from `power_on` before t = 0 on; `going` raises where that is to end."""

        def pump(t: Nanos) -> Nanos:
            going()
            boot(t, t + self.tick)
            return t + self.tick

        boot = self.plant.live if self.searching else self.plant.idle
        start = -self.power_on
        for wake in self.wake:
            wake(start, going)
        self.carriage.start(start)
        self.master.boot(pump, start, 0)
        self.plant.start()

    def stop(self, t: Nanos) -> None:
        """Stops the drives quickly, from `t` or where the bench has got to, and waits for their rest."""
        now = self.carriage.wire.now
        t = max(t, -(-now // self.tick) * self.tick)
        self.carriage.stop()
        self.base.stop(t)
        events = self.base.ears.events
        known, started = len(events), self.base.started
        try:
            self._settle(t)
        finally:
            del events[known:]  # of drives that stop as they are told
            if started:
                events += [BusEvent(t, name, NOT_STOPPED) for name in self.base.moving]
            for flush in self.flush:
                flush()

    def _settle(self, t: Nanos) -> None:
        """Goes on with SYNC and heartbeats, nothing but quick stop in the PDOs, until all drives rest."""
        end = t + STANDSTILL
        try:
            while t < end:
                self.plant.advance(t, t + self.period)
                t += self.period
                self.base.read(t)
                if not self.base.moving:
                    return
                self.base.write(t, Command(0.0, 0.0))
        except BusError:  # a drive is silent: nothing more can be told to it
            self.plant.advance(t, end)

    def events(self) -> list[str]:
        """Returns what the drives did that they should not have and what befell the bus, one a line."""
        faults = self.faults.events if self.faults is not None else []
        told = sorted([*self.base.ears.events, *faults], key=lambda event: event.t)
        return [f"t = {seconds(event.t):.3f} s: {event.drive}: {event.text}" for event in told]
