"""What holds of a drive whatever comes over the bus, worked out from its dictionary alone."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable
from unittest import mock

from firmware_sim import Drive, Frame, drive
from firmware_sim.axis import Axis
from firmware_sim.cia402 import State
from firmware_sim.dictionary import ENTRIES
from firmware_sim.entry import key
from firmware_sim.nmt import NmtState
from tests.firmware import profile
from tests.firmware.noise import Pins
from tests.firmware.wire import NODE

EDGES = frozenset(
    {
        *((before, after) for (before, _), after in profile.TRANSITIONS.items()),
        *((state, state) for state in (State.ENABLED, State.QUICK_STOP)),  # on a ramp out, or held
        *((state, State.REACTION) for state in (State.ENABLED, State.QUICK_STOP)),
        *((state, State.FAULT) for state in State if state not in (State.NOT_READY, State.FAULT)),
        (State.QUICK_STOP, State.SWITCH_ON_DISABLED),
    }
)


class WatchedAxis(Axis):
    """An axis that lets nothing but transitions of the profile happen; `edges` counts them."""

    edges: Counter[tuple[State, State]]
    resetting = False

    def reset(self) -> None:
        self.resetting = True
        super().reset()
        self.resetting = False

    def _enter(self, state: State) -> None:
        if not self.resetting:
            edge = (self.state, state)
            assert edge in EDGES, edge
            if self.state is State.FAULT and state is not State.FAULT:
                assert self.values[key(0x6040)] & 0x80, "only a reset leads out of a fault"
            self.edges[edge] += 1
        super()._enter(state)


class Watched:
    """A drive whose every frame and tick is looked at."""

    def __init__(self) -> None:
        with mock.patch.object(drive, "Axis", WatchedAxis):
            self.drive = Drive(NODE)
        self.axis = self.drive._axis
        assert isinstance(self.axis, WatchedAxis)
        self.edges = self.axis.edges = Counter()
        self.sent: Counter[str] = Counter()
        self.modes: Counter[int] = Counter()  # ticks with power
        self._values = self.axis.values

    def heed(self, t: int, frame: Frame) -> None:
        """Hands over a frame."""
        before = self.drive._node.state
        self.drive.on_frame(t, frame)
        self._check(before)

    def tick(self, t: int, pins: Pins) -> None:
        """Runs a tick."""
        before = self.drive._node.state
        duty = self.drive.tick(t, *pins)
        assert -32767 <= duty <= 32767
        assert self.drive.bridge_enabled or duty == 0
        if self.drive.bridge_enabled:
            self._check_duty(duty / 32767, pins)
            self.modes[self._values[key(0x6061)]] += 1
        self._check(before)

    def _check_duty(self, duty: float, pins: Pins) -> None:
        """The duty drives no more current than 2013:1 at the speed that the drive has measured.

        i = (U d − K w) / R; where the wheel itself drives more than that, d is the full duty against it.
        """
        values, volts = self._values, max(1.0, pins.supply / 4)
        resistance, emf, limit = values[key(0x2012, 1)], values[key(0x2012, 2)], values[key(0x2013, 1)]
        back = emf * self.axis.meter.speed
        most, rounding = resistance * limit / volts, 1.1 / 32767
        low, high = back / volts - most, back / volts + most
        assert duty <= max(high, -1.0) + rounding
        assert duty >= min(low, 1.0) - rounding

    def _check(self, before: NmtState) -> None:
        axis, values = self.axis, self._values
        assert axis.bridge_enabled == (axis.state in profile.POWERED)
        most = values[key(0x607F)] * math.tau / values[key(0x2001)]
        assert abs(axis.speed_ref) <= most * (1 + 1e-12)
        assert axis.bridge_enabled or axis.speed_ref == 0.0
        if axis.positioner.homing.searching:
            assert (axis.state, values[key(0x6061)]) == (State.ENABLED, 6)
        assert values[key(0x1001)] & 1 or not axis.faulted
        if self.drive.outbox:
            self._check_sent(self.drive.outbox, {before, self.drive._node.state})
            self.drive.outbox.clear()

    def _check_sent(self, frames: Iterable[Frame], states: set[NmtState]) -> None:
        """A node that is stopped says nothing but its heartbeat; before it is operational it sends no PDO."""
        values = self._values
        kinds = {0x700 + NODE: "heartbeat", 0x580 + NODE: "SDO", values[key(0x1014)] & 0x7FF: "EMCY"}
        for frame in frames:
            kind = kinds.get(frame.id, "PDO")
            self.sent[kind] += 1
            assert 0 < frame.id <= 0x7FF
            assert len(frame.data) <= 8
            assert not frame.extended
            assert not frame.remote
            assert kind == "heartbeat" or states != {NmtState.STOPPED}
            assert kind != "PDO" or NmtState.OPERATIONAL in states

    def check_dictionary(self) -> None:
        """Every value is one that its entry takes, and the statusword shows the state."""
        self.axis.refresh()
        for where, entry in ENTRIES.items():
            value = self._values[where]
            if entry.writable:
                entry.check(value)
            assert entry.type.unpack(entry.type.pack(value)) == value, hex(where)
        assert profile.state(self._values[key(0x6041)]) is self.axis.state
