"""All PDOs of a node: what a SYNC moves, and what the timers send."""

from __future__ import annotations

from typing import Any

from firmware_sim.application import Application
from firmware_sim.entry import key
from firmware_sim.frame import Frame
from firmware_sim.objects.pdo import PDOS, TX_PARAMETERS
from firmware_sim.pdo import Rpdo, Tpdo
from firmware_sim.watchdog import NEVER

_WINDOW = key(0x1007)


class ProcessData:
    """Works only between `start` and `stop`, which is while the node is operational."""

    __slots__ = ("_app", "_cyclic", "_last_sync", "_running", "_values", "_waiting", "rpdos", "tpdos")

    def __init__(self, values: dict[int, Any], app: Application) -> None:
        self._values = values
        self._app = app
        self._running = False
        self._last_sync = -NEVER
        self.rpdos = [Rpdo(values, number) for number in range(PDOS)]
        self.tpdos = [Tpdo(values, number) for number in range(PDOS)]
        self._cyclic: tuple[Tpdo, ...] = ()
        self._waiting = False  # whether an RPDO waits for SYNC

    def rebuild(self, t: int, index: int) -> None:
        """Compiles the PDO anew that this object (parameters or mapping) belongs to."""
        number = index & 0x1FF
        if index < TX_PARAMETERS:
            self.rpdos[number] = Rpdo(self._values, number)
            return
        self.tpdos[number] = Tpdo(self._values, number)
        if self._running:
            self.tpdos[number].start(t)
        self._select()

    def start(self, t: int) -> None:
        self._running = True
        for tpdo in self.tpdos:
            tpdo.start(t)
        self._select()

    def stop(self) -> None:
        self._running = False
        for tpdo in self.tpdos:
            tpdo.stop()
        for rpdo in self.rpdos:
            rpdo.pending = None
        self._waiting = False

    @property
    def due(self) -> int:
        return min(tpdo.due for tpdo in self.tpdos)

    def sync(self, t: int) -> list[Frame]:
        """Samples actual values, then lets the commands received since the last SYNC act."""
        self._last_sync = t
        self._app.refresh()
        frames = [frame for tpdo in self._cyclic if (frame := tpdo.sync()) is not None]
        if self._waiting:
            self._waiting = False
            for rpdo in self.rpdos:
                if rpdo.pending is not None:
                    self._apply(rpdo, rpdo.pending)
                    rpdo.pending = None
        return frames

    def receive(self, t: int, rpdo: Rpdo, data: bytes) -> bool:
        """Takes an RPDO, to act now or at the next SYNC; tells whether it was long enough."""
        if len(data) < rpdo.size:
            return False
        if not rpdo.synchronous:
            self._apply(rpdo, data)
        else:
            window = self._values[_WINDOW]  # µs
            if not window or t - self._last_sync <= window * 1000:
                rpdo.pending = bytes(data)
                self._waiting = True
        return True

    def event(self, t: int) -> None:
        """Discrete values may have changed: schedules the asynchronous PDOs that show them."""
        if self._running:
            self._app.refresh()
            for tpdo in self.tpdos:
                tpdo.event(t)

    def poll(self, t: int) -> list[Frame]:
        """Returns the asynchronous PDOs that are due."""
        due = [tpdo for tpdo in self.tpdos if t >= tpdo.due]
        if due:
            self._app.refresh()
        return [tpdo.poll(t) for tpdo in due]

    def _select(self) -> None:
        self._cyclic = tuple(tpdo for tpdo in self.tpdos if tpdo.synchronous and tpdo.cob is not None)

    def _apply(self, rpdo: Rpdo, data: bytes) -> None:
        if rpdo.apply(data):
            self._app.changed(0x6040 if rpdo.controls else 0x60FF)
