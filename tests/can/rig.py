"""Two firmware drives on a wire, each turning a shaft that is a first-order lag."""

from __future__ import annotations

from math import tau

from firmware_sim.drive import Drive
from hilbed.can.base import CanBase
from hilbed.can.master import Master
from hilbed.can.port import Port
from hilbed.can.specs import BusSpec, NodeSpec, resolve
from hilbed.can.wire import Wire
from hilbed.clock import MILLISECOND
from hilbed.robots.diffdrive import DiffDrive, DiffDriveSpec
from hilbed.types import Command, Frame, Nanos, Odometry, Transfer

COUNTS = 66_000
PERIOD: Nanos = 10 * MILLISECOND


class Shaft:
    """A wheel that follows the duty: 24 rad/s at full duty, 50 ms."""

    def __init__(self, wire: Wire, node: int, name: str) -> None:
        self.drive = Drive(node)
        self.angle = 0.0
        self.speed = 0.0
        self.powered = True
        self.current = 500  # mA
        self.supply = 96  # quarters of a volt
        self._port: Port = wire.attach(name, self._on_frame)

    def _on_frame(self, t: Nanos, frame: Frame) -> None:
        if self.powered:
            self.drive.on_frame(t, frame)
            self._flush(t)

    def _flush(self, t: Nanos) -> None:
        for frame in self.drive.outbox:
            self._port.send(t, Frame(*frame))
        self.drive.outbox.clear()

    def tick(self, t: Nanos) -> None:
        if not self.powered:
            return
        duty = self.drive.tick(t, round(self.angle / tau * COUNTS), self.current, self.supply) / 32767
        self._flush(t)
        self.speed += (24.0 * duty - self.speed) * 0.02
        self.angle += self.speed * 1e-3


class TwoDrives:
    """Wire, two shafts and a controller's base, booted on request."""

    def __init__(
        self, nodes: dict[str, NodeSpec] | None = None, bus: BusSpec | None = None, powered: int = 2
    ) -> None:
        self.transfers: list[Transfer] = []
        self.wire = Wire(500_000, self.transfers.append)
        self.robot = DiffDrive(DiffDriveSpec())
        self.nodes = resolve(nodes or {}, self.robot.drives)
        self.port = self.wire.attach("controller")
        self.stranger = self.wire.attach("stranger")
        self.shafts = [Shaft(self.wire, node.id, node.name) for node in self.nodes]
        for shaft in self.shafts[powered:]:
            shaft.powered = False
        self.base = CanBase(self.robot, self.port, self.nodes, bus or BusSpec())

    def pump(self, t: Nanos) -> Nanos:
        for shaft in self.shafts:
            shaft.tick(t)
        self.wire.advance(t + MILLISECOND)
        return t + MILLISECOND

    def boot(self, start: Nanos = -600 * MILLISECOND) -> Nanos:
        return Master(self.nodes, self.port, PERIOD).boot(self.pump, start)

    def cycle(self, t: Nanos, command: Command) -> Odometry:
        """Reads, writes, and lets a period pass."""
        odometry = self.base.read(t)
        self.base.write(t, command)
        end = t + PERIOD
        while t < end:
            t = self.pump(t)
        return odometry
