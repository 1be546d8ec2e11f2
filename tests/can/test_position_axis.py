"""A tricycle's base on the bus: one drive of a wheel, one that holds an angle."""

from __future__ import annotations

import struct
from math import inf, nan, pi, tau

import pytest

from hilbed.can.base import CanBase
from hilbed.can.configuration import steps
from hilbed.can.master import Master
from hilbed.can.node import Node
from hilbed.can.position_axis import PositionAxis, axis_of
from hilbed.can.specs import BusSpec, NodeSpec, resolve, with_table
from hilbed.can.wire import Wire
from hilbed.clock import MILLISECOND
from hilbed.robots.tricycle import Tricycle, TricycleSpec
from hilbed.types import Command, Frame, Nanos, Received, ScenarioError
from tests.can.rig import COUNTS, PERIOD, Shaft

ROBOT = Tricycle(TricycleSpec(drive="front", wheelbase=1.0, wheel_radius=0.1))
POSITION = 0x607A
NODES = resolve({}, ROBOT.drives)


class Tape:
    """A bus that keeps what is sent and delivers what it is told to."""

    def __init__(self) -> None:
        self.sent: list[Frame] = []
        self.waiting: list[Received] = []

    def send(self, _: Nanos, frame: Frame) -> None:
        self.sent.append(frame)

    def recv(self, _: Nanos) -> list[Received]:
        heard, self.waiting = self.waiting, []
        return heard

    def answer(self, t: Nanos, turned: float, angle: float) -> None:
        """Both drives answer SYNC: counts of a wheel that has turned, and of an axis at an angle (rad)."""
        for frame in (
            Frame(0x181, struct.pack("<Hih", 0x27, 0, 0)),
            Frame(0x281, struct.pack("<ih", round(turned / tau * COUNTS), 0)),
            Frame(0x182, struct.pack("<Hih", 0x27, round(angle / tau * COUNTS), 0)),
            Frame(0x282, struct.pack("<ih", 0, 0)),
        ):
            self.waiting.append(Received(t, frame))


def test_a_steering_axis_has_its_own_table_wherever_it_is() -> None:
    assert [(node.name, node.id, node.table.name, node.mode) for node in NODES] == [
        ("traction", 1, "hilbed402", "csv"),
        ("steering", 2, "hilbed402-csp", "csp"),
    ]
    rear = resolve({}, TricycleSpec(drive="rear").drives)
    assert [node.id for node in rear] == [1, 2, 3]
    assert with_table("steering", "ecu") == {"kind": "ecu", "table": "hilbed402-csp"}
    assert with_table("steering", {"table": "mine.yaml"})["table"] == "mine.yaml"
    assert with_table("left", "ecu") == "ecu"
    with pytest.raises(ScenarioError, match="steering is told a position"):
        resolve({"steering": NodeSpec()}, ROBOT.drives)


def test_orders_are_counts_of_the_angle() -> None:
    bus = Tape()
    CanBase(ROBOT, bus, NODES, BusSpec()).write(0, Command(0.5, -0.25))
    orders = {frame.id: struct.unpack("<Hi", frame.data) for frame in bus.sent if frame.id in (0x201, 0x202)}
    assert orders[0x201] == (0x0F, round(5.0 / tau * COUNTS))
    assert orders[0x202] == (0x0F, round(-0.25 / tau * COUNTS))


@pytest.mark.parametrize("angle", [1e9, -1e9])
def test_an_angle_beyond_the_object_is_the_farthest_that_it_holds(angle: float) -> None:
    axis = PositionAxis(NODES[1])
    axis.ask(angle)
    assert axis.raw in (2**31 - 1, -(2**31))
    assert (axis.raw > 0) == (angle > 0)


def test_odometry_takes_the_angle_half_way() -> None:
    bus = Tape()
    base = CanBase(ROBOT, bus, NODES, BusSpec())
    turned = 0.0
    for k, angle in enumerate((0.0, 0.2, 0.2)):
        base.write(k * PERIOD, Command(0.5, 0.2))
        turned += 0.05
        bus.answer(k * PERIOD + MILLISECOND, turned, angle)
        odometry = base.read((k + 1) * PERIOD)
        if k:
            middle = (0.1, 0.2)[k - 1]
            expected = ROBOT.travel([0.05, middle])
            assert (odometry.distance, odometry.turn) == pytest.approx(expected, abs=1e-5)
    steering = odometry.drives["steering"]
    assert steering.angle_ref == 0.2
    assert steering.angle_measured == pytest.approx(0.2, abs=1e-4)
    assert steering.speed_ref != steering.speed_ref  # what its drive makes of it is not known here


def test_a_stop_leaves_the_steering_where_it_is_told_to_be() -> None:
    bus = Tape()
    base = CanBase(ROBOT, bus, NODES, BusSpec())
    base.write(0, Command(0.5, 0.3))
    bus.sent.clear()
    base.stop(PERIOD)
    word, target = struct.unpack("<Hi", next(f.data for f in bus.sent if f.id == 0x202))
    assert (word, target) == (0x02, round(0.3 / tau * COUNTS))
    assert struct.unpack("<Hi", next(f.data for f in bus.sent if f.id == 0x201)) == (0x02, 0)


def test_what_is_written_to_it_at_boot() -> None:
    node = resolve({}, ROBOT.drives)[1]
    told = {(entry.index, entry.sub): value for entry, value in steps([node], PERIOD)}
    assert told[0x6060, 0] == 6  # homing; its own mode comes after it
    assert told[0x6098, 0] == 37
    assert told[POSITION, 0] == 0
    assert (told[0x1600, 1], told[0x1600, 2]) == (0x60400010, 0x607A0020)
    assert [told[0x1A00, k] for k in (1, 2, 3)] == [0x60410010, 0x60640020, 0x60770010]


def test_it_is_homed_at_boot_where_it_stands() -> None:
    """Its counter starts anywhere; from then on its position is the angle."""
    wire = Wire(500_000, lambda _: None)
    port = wire.attach("controller")
    shafts = [Shaft(wire, node.id, node.name) for node in NODES]
    shafts[1].angle = 0.7
    offset = NODES[1].table.settings["home"].raw(1000.0)
    nodes = (NODES[0], Node("steering", 2, NODES[1].table, "csp", {"home": offset}))

    def pump(t: Nanos) -> Nanos:
        for shaft in shafts:
            shaft.tick(t)
        wire.advance(t + MILLISECOND)
        return t + MILLISECOND

    Master(nodes, port, PERIOD).boot(pump, -900 * MILLISECOND)
    base, t = CanBase(ROBOT, port, nodes, BusSpec()), 0
    held = shafts[1].angle
    for _ in range(5):
        base.read(t)
        base.write(t, Command(0.0, 1000 / COUNTS * tau))
        for _ in range(10):
            t = pump(t)
    measured = base.read(t).drives["steering"].angle_measured
    assert measured == pytest.approx(1000 / COUNTS * tau, abs=1e-3)
    assert shafts[1].angle == pytest.approx(held, abs=1e-3)


def test_nothing_that_is_not_finite_goes_out() -> None:
    assert isinstance(axis_of(NODES[1]), PositionAxis)
    assert not isinstance(axis_of(NODES[0]), PositionAxis)
    base = CanBase(ROBOT, Tape(), NODES, BusSpec())
    for bad in (nan, inf):
        with pytest.raises(Exception, match="the controller asked for"):
            base.write(0, Command(0.0, bad))
    assert pi / 4 == ROBOT.limited(Command(0.0, 2.0))[1]
