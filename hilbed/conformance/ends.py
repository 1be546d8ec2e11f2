"""The drive's bus: any python-can interface in real time, or the wire with a drive in this process."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import NamedTuple

from hilbed.bustools.live import open_bus
from hilbed.can.link import Link
from hilbed.can.wire import Wire
from hilbed.clock import MILLISECOND
from hilbed.drive.desk import Build, Desk
from hilbed.types import Nanos

WIRE = "hilbed"
_FOREVER: Nanos = 1 << 62


class End(NamedTuple):
    """A link to the drive; its bus's name; whether that is the simulated wire."""

    link: Link
    name: str
    exact: bool


@contextmanager
def live(interface: str | None, channel: str | None, bitrate: int | None) -> Iterator[End]:
    """Opens a python-can bus; ScenarioError where it cannot be opened."""
    with open_bus(interface, channel, bitrate, step=0.001) as bus:
        yield End(Link(bus, bus.pump, bus.now, _FOREVER), bus.adapter.name, exact=False)


def on_the_wire(desk: Desk, bitrate: int) -> End:
    """Returns a drive of this process on a wire of its own, in simulated time."""
    wire = Wire(bitrate)
    port, drive = wire.attach("tester"), wire.attach("drive")

    def pump(t: Nanos) -> Nanos:
        """Runs the drive's next millisecond."""
        for frame in desk.tick(t, [received.frame for received in drive.recv(t)]):
            drive.send(t, frame)
        wire.advance(t + MILLISECOND)
        return t + MILLISECOND

    return End(Link(port, pump, 0, _FOREVER), f"wire, {bitrate} bit/s", exact=True)


def simulated(node: int, bitrate: int) -> End:
    """Returns the simulated drive with its own data, as `hilbed drive` has it."""
    return on_the_wire(Desk(Build(node)), bitrate)
