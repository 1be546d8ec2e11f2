"""The robot behind a CAN bus: `ports.Base` that speaks CANopen to its drives.

A cycle starts with SYNC: the drives latch what they measure and answer, and the targets of the cycle before
act. Then the new targets go out. So what `read` returns was sampled at the last SYNC, a period ago, and a
command acts a period after it was written: as on a real bus with synchronous PDOs.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from math import isfinite

from hilbed.can import cia402, nmt
from hilbed.can.axis import ENABLED_BITS, STATE_BITS, STATUS, Axis, Route
from hilbed.can.cob import CONTROLLER_ID, SYNC_FRAME
from hilbed.can.ears import Ears
from hilbed.can.node import Node
from hilbed.can.position_axis import axis_of
from hilbed.can.specs import BusSpec
from hilbed.can.stations import stations
from hilbed.clock import MILLISECOND, nanos, seconds
from hilbed.ports import Bus, Robot
from hilbed.types import BusError, Command, Diverged, Nanos, Odometry

STANDING = 0.1
"""rad/s; a wheel that turns more slowly stands."""


class CanBase:
    """Drives that have been booted, read and written once a cycle.

    nodes: in the order of the robot's drives. ears: what the drives said besides PDOs (`ears.events`),
    frames that were ignored; silences: how often a drive went silent.
    """

    def __init__(self, robot: Robot, bus: Bus, nodes: Sequence[Node], spec: BusSpec) -> None:
        self.silences = 0
        self._robot = robot
        self._bus = bus
        self._axes = tuple(map(axis_of, nodes))
        self._elsewhere = tuple(axis for axis in self._axes if axis.node.kind == "real")
        self._stopping = False
        self.ears = Ears(self._axes)
        self._stations = stations(self._axes)
        self._routes: dict[int, tuple[Route, ...]] = {}
        for axis in self._axes:
            for identifier, route in axis.routes().items():
                self._routes[identifier] = (*self._routes.get(identifier, ()), route)
        shortest = min((axis.node.table.heartbeat.controller for axis in self._axes), default=100)
        self._alive = nmt.HeartbeatProducer(bus, CONTROLLER_ID, shortest * MILLISECOND)
        self._patience = nanos(spec.silent_after)
        self._on_silence = {"hold": self._hold, "quick_stop": self.stop, "fail": self._fail}[spec.silent]
        self._syncs = 0
        self._sync: Nanos | None = None
        self._sync_before: Nanos | None = None
        self._sampled: Nanos | None = None
        self._rates = (0.0, 0.0)

    def read(self, t: Nanos) -> Odometry:
        """Returns what the drives measured at the last SYNC that all of them have answered.

        Stamped with that SYNC's time (with `t` before the first); frames of any content are survived and
        counted. BusError where a drive is silent and the policy is to fail, or a real one has stopped by
        itself: nothing that is simulated would tell.
        """
        routes, ears = self._routes, self.ears
        for received in self._bus.recv(t):
            at, (identifier, data, extended, remote) = received
            known = routes.get(identifier)
            if known is None or extended or remote:
                ears.hear(received)
                continue
            for axis, unpack, slots, positioned in known:
                try:
                    raw = unpack(data)
                except struct.error:
                    ears.ignored += 1
                    axis.misfits.setdefault(identifier, (at, len(data)))
                    break
                if axis.misfits:
                    axis.misfits.pop(identifier, None)
                values = axis.values
                for slot, value in zip(slots, raw):  # noqa: B905  (as long as each other by construction)
                    values[slot] = value
                axis.heard = at
                if positioned:
                    axis.fresh = self._syncs
                if values[STATUS] & STATE_BITS != axis.state:
                    ears.new_state(at, axis)
        self._watch(t)
        return self._odometry(t)

    def write(self, t: Nanos, command: Command) -> None:
        """Sends SYNC, a target to every drive, the heartbeat if due; Diverged if a command is not finite."""
        if not (isfinite(command.v) and isfinite(command.w)):
            raise Diverged(f"t = {seconds(t):g} s: the controller asked for {command}")
        send = self._bus.send
        send(t, SYNC_FRAME)
        if self._sync is None:
            for axis in self._axes:
                axis.heard = axis.alive = t
        self._sync_before = self._sync
        self._sync = t
        self._syncs += 1
        for axis, target in zip(self._axes, self._robot.wheel_speeds(command), strict=True):
            axis.ask(target)
        for station in self._stations:
            for frame in station.orders():
                send(t, frame)
        self._alive.tick(t)

    def stop(self, t: Nanos) -> None:
        """Tells every drive to stop quickly, at once and for good.

        By SDO, which acts on arrival; and by PDO, so that the next SYNC finds no older order to go on.
        """
        self._stopping = True
        for station in self._stations:
            for frame in station.stop():
                self._bus.send(t, frame)

    @property
    def faulted(self) -> tuple[str, ...]:
        """Names of the drives whose last statusword says fault."""
        faults = (cia402.FAULT, cia402.FAULT_REACTION)
        return tuple(a.node.name for a in self._axes if cia402.state_of(a.values[STATUS]) in faults)

    @property
    def silent(self) -> tuple[str, ...]:
        """Names of the drives that do not answer."""
        return tuple(axis.node.name for axis in self._axes if axis.silent)

    @property
    def started(self) -> bool:
        """Whether a cycle has begun."""
        return self._syncs > 0

    @property
    def moving(self) -> tuple[str, ...]:
        """Names of the drives that do not say that they are no longer enabled and their wheels stand."""
        return tuple(
            axis.node.name
            for axis in self._axes
            if cia402.state_of(axis.values[STATUS]) == cia402.ENABLED
            or not abs(axis.signals().speed_measured) < STANDING
        )

    @property
    def late(self) -> dict[str, int]:
        """How often each drive's answer to a SYNC had not come by the end of its cycle."""
        return {axis.node.name: axis.late for axis in self._axes}

    def _odometry(self, t: Nanos) -> Odometry:
        distance = turn = 0.0
        axes, robot = self._axes, self._robot
        if self._syncs and all(axis.fresh == self._syncs for axis in axes):
            distance, turn = robot.travel([axis.turned() for axis in axes])
            self._sampled = self._sync
        elif self._syncs:
            for axis in axes:
                axis.late += axis.fresh != self._syncs
        signals = {axis.node.name: axis.signals() for axis in axes}
        rates = robot.travel([axis.rate() for axis in axes])
        if isfinite(rates[0]):  # all drives have spoken
            self._rates = rates
        v, w = self._rates
        return Odometry(t if self._sampled is None else self._sampled, distance, turn, v, w, signals)

    def _watch(self, t: Nanos) -> None:
        """Finds drives that leave two SYNCs unanswered for longer than allowed, or three heartbeats out.

        And real drives that are no longer enabled though nobody has stopped them.
        """
        for axis in self._elsewhere:
            if axis.state != ENABLED_BITS and not self._stopping:
                state = cia402.state_of(axis.values[STATUS])
                words = self._last_words(axis)
                raise BusError(f"t = {seconds(t):g} s: {axis.node} has stopped by itself: {state}{words}")
        before = self._sync_before
        if before is None:
            return
        for axis in self._axes:
            silent = self._silence(t, axis, before)
            if bool(silent) == bool(axis.silent):
                continue
            axis.silent = silent
            self.ears.note(t, axis, silent or "answers again")
            if silent:
                self.silences += 1
                self._on_silence(t)

    def _silence(self, t: Nanos, axis: Axis, before: Nanos) -> str:
        """Returns since when a drive sends no PDOs, or no heartbeats, or others; empty if all is well."""
        if axis.heard <= before and t - axis.heard > self._patience:
            return f"silent since {seconds(axis.heard):g} s"
        if t - axis.alive > 3 * MILLISECOND * axis.node.table.heartbeat.drive:
            return f"without a heartbeat since {seconds(axis.alive):g} s"
        for identifier, (since, size) in axis.misfits.items():
            if t - since > self._patience:
                pdo = f"PDO {identifier:03X} with {size} bytes, not as mapped,"
                return f"sending {pdo} since {seconds(since):g} s"
        return ""

    def _hold(self, t: Nanos) -> None:
        """Goes on with what was heard last."""

    def _fail(self, t: Nanos) -> None:
        axis = next(axis for axis in self._axes if axis.silent)
        words = self._last_words(axis)
        raise BusError(f"t = {seconds(t):g} s: {axis.node} has been {axis.silent}{words}")

    def _last_words(self, axis: Axis) -> str:
        """Returns the last emergency of a drive: most often the cause of what it does not do any more."""
        said = [e for e in self.ears.events if e.drive == axis.node.name and e.text.startswith("emergency")]
        return f" (t = {seconds(said[-1].t):g} s: {said[-1].text})" if said else ""
