"""A gateway between the wire of the bench and a python-can bus, where other nodes are.

What completes on the wire goes out; what comes in is put on the wire as sent by its node. So the wire's
model stamps every frame, wherever its node is, and the other bus only carries them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Protocol

from hilbed.can.cob import CONTROLLER_ID, HEARTBEAT, SYNC
from hilbed.can.counts import Counts
from hilbed.can.node import Node
from hilbed.can.wire import Wire
from hilbed.clock import seconds
from hilbed.ports import Bus
from hilbed.types import BusError, Frame, Nanos

_SERVICES = (0x080, 0x580, HEARTBEAT)
"""What a node sends besides its PDOs: emergencies, SDO answers, heartbeats."""
CONTROLLER = (SYNC, HEARTBEAT + CONTROLLER_ID)


class Adapter(Protocol):
    """One end of the other bus; BusError where it is lost."""

    name: str
    counts: Counts

    def send(self, frame: Frame) -> None: ...

    def poll(self) -> list[Frame]: ...

    def wait(self, timeout: float) -> list[Frame]: ...

    def purge(self) -> None: ...


class Medium(Protocol):
    """What runs the wire: the wire itself, or one that keeps its time to the wall clock."""

    def advance(self, until: Nanos) -> None: ...


class Gateway:
    """Joins a wire and an adapter; `advance` runs both.

    here, elsewhere: nodes whose firmware is in this process, or on the other bus. lockstep: frames of nobody
    known are counted (`foreign`) and go no further; in real time they are put on the wire as well.
    """

    def __init__(self, wire: Wire, adapter: Adapter, medium: Medium, lockstep: bool) -> None:
        self.adapter = adapter
        self.foreign = 0
        self._wire = wire
        self._medium = medium
        self._heard = wire.attach("gateway", self._carry)
        self._lockstep = lockstep
        self._stranger = None if lockstep else self._heard
        self._here = dict.fromkeys(CONTROLLER, "the controller")
        self._elsewhere: dict[int, Bus] = {}
        self._taken: list[Callable[[Frame], bool]] = []
        self._stopping = False

    def here(self, node: Node) -> None:
        """Notes a node of this process: nobody else may send what it sends."""
        self._here |= dict.fromkeys(_sends(node), str(node))

    def elsewhere(self, node: Node) -> None:
        """Gives a node on the other bus its place on the wire."""
        port = self._wire.attach(node.name, _deaf)
        self._elsewhere |= dict.fromkeys(_sends(node), port)

    def intercept(self, take: Callable[[Frame], bool]) -> None:
        """Asks `take` first about what comes in; what it takes never sees the wire."""
        self._taken.append(take)

    def advance(self, until: Nanos) -> None:
        """Runs the wire to `until`, which sends what completes there, and takes in what has come."""
        self._medium.advance(until)
        self.pull(until)

    def pull(self, t: Nanos, timeout: float = 0.0) -> None:
        """Takes in, at `t`, what has come; waits for at most `timeout` s of the wall clock for anything.

        Raises BusError where the bus is lost, or somebody there sends what a node of this process sends.
        """
        frames: list[Frame] = []
        try:
            frames = self.adapter.wait(timeout) if timeout else self.adapter.poll()
        except BusError as error:
            self._lost(t, error)
        for frame in frames:
            if not any(take(frame) for take in self._taken):
                self._take_in(t, frame)

    def account(self) -> dict[str, str | int]:
        """Returns what verdict.json says: the name of the bus and what was counted there."""
        return {"name": self.adapter.name, **vars(self.adapter.counts), "foreign": self.foreign}

    def stop(self) -> None:
        """From now on a lost bus is no news: what can still be sent, is; old commands are not.

        In lockstep nothing is old: simulated time waits for a slow driver, and so does the stop.
        """
        self._stopping = True
        if not self._lockstep:
            self.adapter.purge()

    def _take_in(self, t: Nanos, frame: Frame) -> None:
        identifier = -1 if frame.extended else frame.id
        port = self._elsewhere.get(identifier)
        if port is None:
            self.foreign += 1
            port = self._stranger
            if identifier in self._here and not self._stopping:
                raise BusError(
                    f"t = {seconds(t):.3f} s: {self._here[identifier]} is simulated here, but another node "
                    f"on {self.adapter.name} sends {identifier:03X} as well: two nodes with one number"
                )
        if port is not None:
            port.send(t, frame)

    def _carry(self, t: Nanos, frame: Frame) -> None:
        """Sends what has completed on the wire, unless it has come from the other bus."""
        if not frame.extended and frame.id in self._elsewhere:
            return
        try:
            self.adapter.send(frame)
        except BusError as error:
            self._lost(t, error)

    def _lost(self, t: Nanos, error: BusError) -> None:
        """Ends the run where it has not ended yet."""
        if not self._stopping:
            raise BusError(f"t = {seconds(t):.3f} s: {error}") from None


def _sends(node: Node) -> Iterable[int]:
    """Returns the identifiers of what a node sends."""
    pdos = (node.table.pdos[name].cob_id for name in node.table.sends)
    return [base + node.id for base in (*_SERVICES, *pdos)]


def _deaf(_: Nanos, frame: Frame) -> None:
    """Keeps a port's inbox empty: the node hears everything on its own bus."""
