"""The axes of a plant: for each drive what the scenario's `kind` says, chosen from a dict."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from hilbed.build.standin import StandIn, plate
from hilbed.can.drive_table import OWN, load_table
from hilbed.can.node import Node
from hilbed.can.port import Port
from hilbed.can.reported import Reported
from hilbed.can.terminals import Terminals
from hilbed.can.wire import Wire
from hilbed.plant.axes import (
    Axis,
    EcuAxis,
    HomeSwitch,
    MirroredAxis,
    RealAxis,
    RealSteeringAxis,
    SimulatedAxis,
    SwitchedAxis,
    SwitchedEcuAxis,
    own_firmware,
)
from hilbed.plant.drivetrain import DriveTrain
from hilbed.plant.encoder import Encoder
from hilbed.plant.specs import STEERING, SimulatedSpec


@dataclass(frozen=True)
class Workshop:
    """What axes are made from; inertia: kg m² that a drive has to move, by name; terminals: of ecu nodes."""

    spec: SimulatedSpec
    inertia: Mapping[str, float]
    wire: Wire
    terminals: Terminals | None
    stand_ins: dict[int, tuple[StandIn, Port]] = field(default_factory=dict)

    def axis(self, node: Node) -> Axis:
        """Returns the axis of a drive, seen from its wheel."""
        axis = _KINDS[node.kind](self, node)
        mounted_mirrored = node.table.units.sign(node.axis) < 0 and node.kind != "real"
        return MirroredAxis(axis) if mounted_mirrored else axis

    def axes(self, nodes: Sequence[Node]) -> list[Axis]:
        return [self.axis(node) for node in nodes]


def _train(shop: Workshop, node: Node) -> DriveTrain:
    spec, machine = shop.spec, shop.spec.machine(node.name)
    return DriveTrain(machine.motor, machine.gear, spec.chopper, spec.tick, shop.inertia[node.name])


def _encoder(shop: Workshop, node: Node) -> Encoder:
    return Encoder(shop.spec.machine(node.name).encoder, shop.spec.tick)


def _switch(shop: Workshop, node: Node) -> HomeSwitch | None:
    """Returns the home switch of the steering axis, if it has one."""
    steering = shop.spec.steering
    if node.name != STEERING or steering is None or steering.switch is None:
        return None
    return HomeSwitch(steering.switch, node.table.units.sign(node.axis))


def _simulated(shop: Workshop, node: Node) -> Axis:
    """The bench's own firmware where the table is its own, else a stand-in that speaks as the table says."""
    train, encoder = _train(shop, node), _encoder(shop, node)
    if node.table.identity == load_table(OWN).identity:
        make, attach, switch = own_firmware(node.id), shop.wire.attach, _switch(shop, node)
        if switch is not None:
            return SwitchedAxis(node.name, make, train, encoder, attach, switch)
        return SimulatedAxis(node.name, make, train, encoder, attach)
    made = shop.stand_ins.get(node.id)
    if made is None:
        made = shop.stand_ins[node.id] = (
            StandIn(node.id, node.table, plate(shop.spec.machine(node.name))),
            shop.wire.attach(node.name),
        )
    standin, port = made
    side = standin.axes[node.axis - 1]
    return SimulatedAxis(node.name, lambda _: side, train, encoder, lambda _: port)


def _ecu(shop: Workshop, node: Node) -> Axis:
    assert shop.terminals is not None
    terminal, switch = shop.terminals.by_node[node.id], _switch(shop, node)
    if switch is not None:
        return SwitchedEcuAxis(node.name, _train(shop, node), _encoder(shop, node), terminal, switch)
    return EcuAxis(node.name, _train(shop, node), _encoder(shop, node), terminal)


def _real(shop: Workshop, node: Node) -> Axis:
    """The wheel is turned with what a motor of the scenario's kind can do at most."""
    motor, gear, _ = shop.spec.machine(node.name)
    torque = motor.max_current * motor.torque_constant * gear.ratio * gear.efficiency
    kind = RealSteeringAxis if node.table.positions else RealAxis
    return kind(node.name, Reported(node, shop.wire.attach), torque)


_KINDS = {"simulated": _simulated, "ecu": _ecu, "real": _real}
