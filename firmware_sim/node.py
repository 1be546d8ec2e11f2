"""The CANopen side of the drive: which frame goes to which service, and what is due when."""

from __future__ import annotations

from collections.abc import Callable, Collection
from functools import partial
from typing import TypeAlias

from firmware_sim.application import Application
from firmware_sim.dictionary import ObjectDictionary
from firmware_sim.emergency import Emergency
from firmware_sim.entry import key
from firmware_sim.errors import ErrorCode, Errors
from firmware_sim.frame import AnyFrame, Frame
from firmware_sim.heartbeat import Consumers, Producer
from firmware_sim.nmt import COMMANDS, ERROR_STATES, RESET_COMMUNICATION, RESET_NODE, TALKING, NmtState
from firmware_sim.pdo import Rpdo, Tpdo
from firmware_sim.process_data import ProcessData
from firmware_sim.sdo import SdoServer
from firmware_sim.watchdog import NEVER, Watchdog

Accept: TypeAlias = Callable[[Collection[int]], None]


class Node:
    """One CANopen node; the frames that it sends are appended to `outbox`.

    due: when `poll` has to be called at the latest (ns); malformed: frames for this node that were
    dropped for their length; accept: told the identifiers that the node heeds when they change.
    """

    def __init__(
        self,
        number: int,
        dictionary: ObjectDictionary,
        errors: Errors,
        app: Application,
        accept: Accept | None = None,
    ) -> None:
        self.number = number
        self._accept = accept
        self.outbox: list[Frame] = []
        self.due = -NEVER
        self.malformed = 0
        self.state = NmtState.INITIALISING
        self._dictionary = dictionary
        self._values = dictionary.values
        self._errors = errors
        self._app = app
        self._emergency = Emergency(self._values, errors)
        # Nothing is connected before power-on.
        self._services: dict[int, Callable[[int, bytes], None]] = {}
        self._remotes: dict[int, Tpdo] = {}
        self._now = 0
        self._configure()

    def _configure(self) -> None:
        """Makes every part of the communication anew from the dictionary."""
        self._producer = Producer(self._values)
        self._consumers = Consumers(self._values)
        self._sync_watch = Watchdog(self._values[key(0x2002)])
        self._sdo = SdoServer(self._dictionary, self._written)
        self._pdos = ProcessData(self._values, self._app)

    def receive(self, t: int, frame: AnyFrame) -> None:
        """Hands a frame to its service; one that is nobody's is dropped."""
        service = self._services.get(frame.id)
        if service is not None and not frame.extended and not frame.remote:
            service(t, frame.data)
        elif frame.remote and not frame.extended and frame.id in self._remotes:
            self._app.refresh()
            self.outbox.append(self._remotes[frame.id].sample())

    def poll(self, t: int) -> None:
        """Does what has become due: boot-up, heartbeats, time-outs, asynchronous PDOs."""
        if self.state is NmtState.INITIALISING:
            self._reset(t, RESET_NODE)
        if self._producer.poll(t):
            self._send(0x700, bytes((self.state,)))
        if self._consumers.poll(t):
            self._lost(t, ErrorCode.HEARTBEAT_LOST)
        if self._sync_watch.poll(t):
            self._lost(t, ErrorCode.COMMUNICATION)
        abort = self._sdo.poll(t)
        if abort is not None:
            self._send(0x580, abort)
        self.outbox += self._pdos.poll(t)
        self._schedule()

    def announce(self, t: int) -> None:
        """Errors or discrete values have changed: sends EMCY and the PDOs that show them."""
        self.outbox += self._emergency.flush(t, self.state in TALKING)
        self._pdos.event(t)
        self.outbox += self._pdos.poll(t)
        self._schedule()

    def _schedule(self) -> None:
        self.due = min(
            self._producer.due,
            self._consumers.due,
            self._sync_watch.due,
            self._sdo.due,
            self._pdos.due,
        )

    def _send(self, function: int, data: bytes) -> None:
        self.outbox.append(Frame(function + self.number, data))

    # ---- network management

    def _connect(self) -> None:
        """Lists the services that the NMT state allows, by identifier."""
        self._services = {0x700 + node: partial(self._on_heartbeat, node) for node in self._consumers.nodes}
        self._remotes = {}
        if self.state is NmtState.OPERATIONAL:
            pdos = self._pdos
            self._services |= {r.cob: partial(self._on_rpdo, r) for r in pdos.rpdos if r.cob is not None}
            self._services[self._values[key(0x1005)] & 0x7FF] = self._on_sync
            self._remotes = {p.cob: p for p in pdos.tpdos if p.cob is not None and p.remote}
        if self.state in TALKING:
            self._services[0x600 + self.number] = self._on_sdo
        self._services[0x000] = self._on_nmt
        if self._accept is not None:
            self._accept(frozenset((*self._services, *self._remotes)))

    def _enter(self, t: int, state: NmtState) -> None:
        self.state = state
        self._sync_watch.disarm()
        if state is NmtState.OPERATIONAL:
            self._pdos.start(t)
        else:
            self._pdos.stop()
        self._connect()
        self._schedule()

    def _on_nmt(self, t: int, data: bytes) -> None:
        if len(data) != 2:
            self.malformed += 1
            return
        command, node = data
        if node not in (0, self.number):
            return
        target = COMMANDS.get(command)
        if command in (RESET_NODE, RESET_COMMUNICATION):
            self._orphan()
            self._reset(t, command)
        elif target is not None and target is not self.state:
            self._orphan()
            self._enter(t, target)

    def _orphan(self) -> None:
        """A master that takes the node out of operation leaves the wheel alone."""
        if self.state is NmtState.OPERATIONAL:
            self._app.disconnected(ErrorCode.COMMUNICATION)

    def _reset(self, t: int, command: int) -> None:
        if command == RESET_NODE:
            self._dictionary.restore(0x0000, 0xFFFF)
            self._app.reset()
            self._errors.pending.clear()
        else:
            self._dictionary.restore(0x1000, 0x1FFF)
            self._errors.restore()
        self._configure()
        self._send(0x700, b"\0")
        self._enter(t, NmtState.PRE_OPERATIONAL)

    def _lost(self, t: int, code: ErrorCode) -> None:
        """SYNC or a heartbeat stays away: EMCY, what 6007 says, then what 1029 says."""
        self._errors.set(code)
        self._app.disconnected(code)
        self.outbox += self._emergency.flush(t, self.state in TALKING)
        target = ERROR_STATES.get(self._values[key(0x1029, 1)])
        if target is not None and self.state is NmtState.OPERATIONAL:
            self._enter(t, target)

    def _found(self, code: ErrorCode) -> None:
        if code in self._errors.active and not self._app.faulted:
            self._errors.clear(code)

    # ---- services

    def _on_sync(self, t: int, data: bytes) -> None:
        if len(data) > 1:
            self.malformed += 1
            return
        if self._errors.active:
            self._found(ErrorCode.COMMUNICATION)
        self._sync_watch.kick(t)
        if self._sync_watch.due < self.due:
            self.due = self._sync_watch.due
        self.outbox += self._pdos.sync(t)

    def _on_rpdo(self, rpdo: Rpdo, t: int, data: bytes) -> None:
        if not self._pdos.receive(t, rpdo, data):
            self.malformed += 1
            self._errors.set(ErrorCode.PDO_TOO_SHORT)
        elif self._errors.active:
            self._found(ErrorCode.PDO_TOO_SHORT)

    def _on_heartbeat(self, node: int, t: int, data: bytes) -> None:
        if len(data) != 1:
            self.malformed += 1
            return
        self._consumers.kick(t, node)
        self._schedule()
        if self._consumers.all_alive:
            self._found(ErrorCode.HEARTBEAT_LOST)

    def _on_sdo(self, t: int, data: bytes) -> None:
        if len(data) != 8:
            self.malformed += 1
            return
        self._now = t
        self._app.refresh()
        answer = self._sdo.request(t, bytes(data))
        if answer is not None:
            self._send(0x580, answer)
        self._schedule()

    def _written(self, index: int) -> None:
        """A client has stored a value: lets the part that uses it know."""
        if index >= 0x2000:
            self._app.changed(index)
        if 0x1400 <= index < 0x1C00:
            self._pdos.rebuild(self._now, index)
            self._connect()
        elif index == 0x1003:
            self._errors.forget()
        elif index == 0x1005:
            self._connect()
        elif index == 0x1016:
            self._consumers = Consumers(self._values)
            self._connect()
        elif index == 0x1017:
            self._producer.due = self._now
        elif index == 0x2002:
            self._sync_watch = Watchdog(self._values[key(0x2002)])
