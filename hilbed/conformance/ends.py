"""The drive's bus: any python-can interface in real time, or the wire with a drive in this process."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, NamedTuple, Protocol, cast

from hilbed.build.standin import StandIn, plate
from hilbed.bustools.live import open_bus
from hilbed.can.drive_table import OWN, DriveTable, load_table
from hilbed.can.link import Link
from hilbed.can.node import Node
from hilbed.can.wire import Wire
from hilbed.clock import MILLISECOND, NEVER
from hilbed.drive.desk import Build, Desk
from hilbed.plant.specs import SimulatedSpec
from hilbed.types import Frame, Nanos

if TYPE_CHECKING:
    from firmware_sim import Drive

WIRE = "hilbed"


class End(NamedTuple):
    """A link to the drive; its bus's name; whether that is the simulated wire."""

    link: Link
    name: str
    exact: bool


@contextmanager
def live(interface: str | None, channel: str | None, bitrate: int | None) -> Iterator[End]:
    """Opens a python-can bus; ScenarioError where it cannot be opened."""
    with open_bus(interface, channel, bitrate, step=0.001) as bus:
        yield End(Link(bus, bus.pump, bus.now, NEVER), bus.adapter.name, exact=False)


class Ticking(Protocol):
    """A drive with its motor: a millisecond at a time, frames in, frames out."""

    def tick(self, t: Nanos, frames: Iterable[Frame]) -> list[Frame]: ...


class OtherDesk:
    """A drive of another type on a desk: a stand-in that speaks as its table says, a motor for each axis."""

    def __init__(self, node: int, table: DriveTable) -> None:
        standin = StandIn(node, table, plate(SimulatedSpec(kind="bullet").machine("left")))
        self.motors = [Desk(Build(node)) for _ in standin.axes]
        for motor, side in zip(self.motors, standin.axes, strict=True):
            motor.firmware = cast("Drive", side)  # the same pins

    def tick(self, t: Nanos, frames: Iterable[Frame]) -> list[Frame]:
        """Runs the node and its first axis, then the others; returns what they send."""
        sent = self.motors[0].tick(t, frames)
        for motor in self.motors[1:]:
            sent += motor.tick(t, ())
        return sent


def on_the_wire(desk: Ticking, bitrate: int) -> End:
    """Returns a drive of this process on a wire of its own, in simulated time."""
    wire = Wire(bitrate)
    port, drive = wire.attach("tester"), wire.attach("drive")

    def pump(t: Nanos) -> Nanos:
        """Runs the drive's next millisecond."""
        for frame in desk.tick(t, [received.frame for received in drive.recv(t)]):
            drive.send(t, frame)
        wire.advance(t + MILLISECOND)
        return t + MILLISECOND

    return End(Link(port, pump, 0, NEVER), f"wire, {bitrate} bit/s", exact=True)


def simulated(node: Node, bitrate: int) -> End:
    """Returns the simulated drive of a table's type, with its own data."""
    own = node.table.identity == load_table(OWN).identity
    return on_the_wire(Desk(Build(node.id)) if own else OtherDesk(node.id, node.table), bitrate)
