"""The drive under test: its objects by their words, in SI units at the wheel, and what was changed in it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from hilbed.can import cia402, nmt
from hilbed.can.cob import EMERGENCY, HEARTBEAT
from hilbed.can.link import Link
from hilbed.can.node import Node
from hilbed.can.objects import Entry, Object
from hilbed.can.sdo import SdoClient, SdoError
from hilbed.clock import MILLISECOND, seconds
from hilbed.types import Frame, HilbedError, Nanos, Received

STATE_TIMEOUT: Nanos = 1000 * MILLISECOND
SDO_TIMEOUT: Nanos = 1000 * MILLISECOND
FAR = 3.0
"""s, as far as a drive that is told a position is sent to have it turn for a while."""
SET_POINT = 0x003F
"""Operation enabled, and a set-point that counts at once."""
SLOWEST = 0.01
"""rad/s, below which a wheel stands."""
NMT_SETTLING: Nanos = 20 * MILLISECOND
HEARTBEAT_PERIOD: Nanos = 20 * MILLISECOND

# Objects of the profile that a table need not name.
STANDARD = {
    "error_register": Object(index=0x1001, type="u8"),
    "heartbeat_consumer": Object(index=0x1016, sub=1, type="u32"),
    "abort_option": Object(index=0x6007, type="i16"),
    "error_code": Object(index=0x603F, type="u16"),
    "quick_stop_option": Object(index=0x605A, type="i16"),
    "mode_display": Object(index=0x6061, type="i8"),
    "max_velocity": Object(index=0x607F, type="u32"),
    "lowest_position": Object(index=0x607D, sub=1, type="i32"),
    "highest_position": Object(index=0x607D, sub=2, type="i32"),
    "profile_velocity": Object(index=0x6081, type="u32"),
    "acceleration": Object(index=0x6083, type="u32"),
    "quick_stop_deceleration": Object(index=0x6085, type="u32"),
    "modes": Object(index=0x6502, type="u32"),
}

# How to get to operation enabled: state, controlword that leads on, state then.
_WAY = (
    (cia402.DISABLED, cia402.SHUTDOWN, cia402.READY),
    (cia402.READY, cia402.SWITCH_ON, cia402.SWITCHED_ON),
    (cia402.SWITCHED_ON, cia402.ENABLE_OPERATION, cia402.ENABLED),
)


class Stuck(HilbedError):
    """The drive does not get where a check wants it to be."""


class Subject:
    """One axis of a node, reached by SDO. `settle` leaves it at rest and gives it back its settings.

    emergencies: when, and which code; alive: when it was last told that its controller lives.
    """

    def __init__(self, link: Link, node: Node) -> None:
        self.link = link
        self.node = node
        self.sdo = SdoClient(link, node.name, node.id, SDO_TIMEOUT)
        self.heartbeats = nmt.HeartbeatConsumer()
        self.emergencies: list[tuple[Nanos, int]] = []
        self.alive: Nanos = link.t
        self._undo: list[Callable[[], None]] = []
        self._changed: set[tuple[int, int]] = set()
        link.listeners += [self.heartbeats.hear, self._hear]

    # ---- objects

    def entry(self, word: str) -> Entry:
        """Returns the entry of a word, for this axis."""
        return self._object(word).of(self.node.axis)

    def read(self, word: str) -> int:
        """Reads an object; SdoError where the drive does not have it."""
        return self._object(word).part(self.node.axis, self.read_entry(self.entry(word)))

    def read_entry(self, entry: Entry) -> int:
        """Reads an entry."""
        return self.sdo.read(entry.index, entry.sub, entry.type)

    def has(self, word: str) -> bool:
        """Tells whether the drive has an object."""
        try:
            self.read(word)
        except SdoError:
            return False
        return True

    def write(self, word: str, value: float) -> None:
        """Writes an object that is given back its value in the end."""
        self.write_entry(self.entry(word), value)

    def write_entry(self, entry: Entry, value: float) -> None:
        """Writes an entry that is given back its value in the end."""
        if (entry.index, entry.sub) not in self._changed:
            was = self.read_entry(entry)
            self._changed.add((entry.index, entry.sub))
            self.in_the_end(lambda: self.put(entry, was))
        self.put(entry, value)

    def put(self, entry: Entry, value: float) -> None:
        """Writes an entry for good."""
        self.sdo.write(entry.index, entry.sub, entry.type, value)

    def in_the_end(self, step: Callable[[], None]) -> None:
        """Adds a step that gives the drive back what it had; they are done last one first."""
        self._undo.append(step)

    def _object(self, word: str) -> Object:
        return self.node.table.objects.get(word) or STANDARD[word]

    # ---- states

    def command(self, word: int) -> None:
        """Writes the controlword."""
        self.put(self.entry("controlword"), word)

    def state(self) -> str:
        """Reads the statusword and returns the name of the state."""
        return cia402.state_of(self.read("statusword"))

    def reach(self, wanted: tuple[str, ...], timeout: Nanos = STATE_TIMEOUT) -> tuple[str, float]:
        """Waits for one of the states; returns the last one seen and the time (s) that it took."""
        begun = self.link.t
        while (state := self.state()) not in wanted and self.link.t - begun < timeout:
            self.link.step()
        return state, seconds(self.link.t - begun)

    def go(self, wanted: str) -> None:
        """Leads the drive to a state on the way to operation enabled; Stuck where it does not get there."""
        self._disable()
        for state, command, following in _WAY:
            if state == wanted:
                return
            self.command(command)
            reached, _ = self.reach((following,))
            if reached != following:
                raise Stuck(f"{self.node}: told to go from {state} to {following}, it is in {reached}")

    def _disable(self) -> None:
        self.command(cia402.DISABLE_VOLTAGE)
        state, _ = self.reach((cia402.DISABLED, cia402.FAULT))
        if state == cia402.FAULT:
            self.command(cia402.FAULT_RESET)
            state, _ = self.reach((cia402.DISABLED,))
            self.command(cia402.DISABLE_VOLTAGE)
        if state != cia402.DISABLED:
            raise Stuck(f"{self.node}: cannot be disabled, it is in {state}")

    def settle(self) -> list[str]:
        """Stops the drive without power and gives it back its settings; returns what it refused."""
        refused: list[str] = []
        for step in (self._rest, *reversed(self._undo)):
            try:
                step()
            except (SdoError, Stuck) as error:
                refused.append(str(error))
        self._undo.clear()
        self._changed.clear()
        return refused

    def _rest(self) -> None:
        self.target(0.0)
        if self.state() == cia402.ENABLED:
            self.command(cia402.QUICK_STOP)
        self.until(lambda speed: abs(speed) < SLOWEST, 2 * STATE_TIMEOUT)  # without power it would coast
        self._disable()

    # ---- network

    def manage(self, specifier: int) -> None:
        """Sends an NMT command and gives the node time to heed it."""
        self.link.send(nmt.command(specifier, self.node.id))
        self.link.pause(NMT_SETTLING)

    @contextmanager
    def guarded(self, consumer: Nanos) -> Iterator[None]:
        """Makes the drive watch a controller that says that it lives until the block ends.

        SdoError where the drive has no heartbeat consumer.
        """
        taken = {self.node.id, *self.heartbeats.states}
        controller = next(number for number in range(127, 0, -1) if number not in taken)

        def beat(t: Nanos) -> None:
            if t >= self.alive + HEARTBEAT_PERIOD:
                self.alive = t
                self.link.send(Frame(HEARTBEAT + controller, bytes((nmt.OPERATIONAL,))))

        self.link.each_step.append(beat)
        try:
            self.link.pause(2 * HEARTBEAT_PERIOD)
            self.write("heartbeat_consumer", controller << 16 | consumer // MILLISECOND)
            self.link.pause(2 * HEARTBEAT_PERIOD)
            yield
        finally:
            self.link.each_step.remove(beat)

    def _hear(self, received: Received) -> None:
        t, frame = received
        if frame.id == EMERGENCY + self.node.id and len(frame.data) == 8 and not frame.extended:
            self.emergencies.append((t, int.from_bytes(frame.data[:2], "little")))

    # ---- motion, at the wheel

    def speed(self) -> float:
        """Reads the speed, rad/s."""
        return self.read("velocity_actual") / self.node.actual_per_radian

    def turned(self, since: int) -> float:
        """Returns the turn (rad) since a position that was read, across the wrap of 32 bits."""
        counts = (self.read("position_actual") - since + 0x80000000 & 0xFFFFFFFF) - 0x80000000
        return counts / self.node.counts_per_radian

    def target(self, speed: float) -> None:
        """Writes the target, rad/s; to a drive that is told a position, one that is FAR seconds away."""
        if self.node.table.positions:
            self.move(self.angle() + FAR * speed)
        else:
            self.put(self.entry("target_velocity"), speed * self.node.velocity_per_radian)

    def angle(self) -> float:
        """Reads the position, rad."""
        return self.read("position_actual") / self.node.counts_per_radian

    def move(self, angle: float) -> None:
        """Writes a target position, rad; in PP it is handed over, to count at once."""
        self.put(self.entry("target_position"), angle * self.node.counts_per_radian)
        if self.node.mode == "pp" and self.state() == cia402.ENABLED:
            for word in (SET_POINT, cia402.ENABLE_OPERATION):
                self.command(word)

    def hurry(self, speed: float) -> None:
        """Has a drive that is told a position go there at a speed, rad/s."""
        rate = abs(speed * self.node.velocity_per_radian)
        self.write("max_velocity", rate)
        if self.node.mode == "pp":
            self.write("profile_velocity", rate)

    def use_mode(self, mode: str) -> None:
        """Writes the mode of operation and waits until it is shown; Stuck where it is not."""
        wanted = self.node.table.modes[mode]
        self.write("mode", wanted)
        begun = self.link.t
        while self.read("mode_display") != wanted:
            if self.link.t - begun > STATE_TIMEOUT:
                raise Stuck(f"{self.node}: mode {wanted} was written, {self.read('mode_display')} is shown")
            self.link.step()

    def run(self, speed: float) -> None:
        """Enables the drive, in PV where it has it, and brings it to a speed; Stuck where that fails."""
        modes = self.node.table.modes
        self.manage(nmt.START)
        self.use_mode("pv" if "pv" in modes else next(iter(modes)))
        if self.node.table.positions:
            self.hurry(speed)
        self.target(0.0)
        self.go(cia402.ENABLED)
        self.target(speed)
        if not self.until(lambda now: abs(now - speed) < 0.05 * abs(speed), 5 * STATE_TIMEOUT):
            raise Stuck(f"{self.node}: told to turn at {speed:g} rad/s, it turns at {self.speed():.3g} rad/s")
        self.link.pause(STATE_TIMEOUT // 5)

    def until(self, condition: Callable[[float], bool], timeout: Nanos) -> bool:
        """Reads the speed until a condition holds; False where it does not within `timeout`."""
        begun = self.link.t
        while not condition(self.speed()):
            if self.link.t - begun > timeout:
                return False
            self.link.step()
        return True
