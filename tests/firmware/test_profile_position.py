"""Profile position mode: set-points by handshake, told by the canopen library, on the tests' own motor."""

from __future__ import annotations

import math

import pytest

from tests.firmware.motor import COUNTS, Wheel
from tests.firmware.test_course import trapezoid
from tests.firmware.test_modes import drive
from tests.firmware.wire import NODE, Wire, operational

PP, CSP = 1, 8
RADIAN = COUNTS / math.tau
READY, NEW, AT_ONCE, RELATIVE, HALT = 0x0F, 0x10, 0x20, 0x40, 0x100
REACHED, LIMITED, ACKNOWLEDGED, LAGS = 0x0400, 0x0800, 0x1000, 0x2000


def positioning(wheel: Wheel, velocity: float = 2.0, acceleration: float = 10.0) -> Wire:
    """Returns a drive in PP; rad/s and rad/s²."""
    wire = operational()
    sdo = wire.node.sdo
    sdo[0x6060].raw = PP
    sdo[0x6081].raw = round(velocity * RADIAN)
    sdo[0x6083].raw = sdo[0x6084].raw = round(acceleration * RADIAN)
    drive(wire, wheel, 5)
    for word in (0x06, 0x07, READY):
        sdo[0x6040].raw = word
    return wire


def offer(wire: Wire, angle: float, how: int = 0) -> None:
    """Offers a set-point (rad) as the bit rises, and lowers it."""
    wire.node.sdo[0x607A].raw = round(angle * RADIAN)
    wire.node.sdo[0x6040].raw = READY | NEW | how
    wire.node.sdo[0x6040].raw = READY


def status(wire: Wire) -> int:
    return int(wire.node.sdo[0x6041].raw)


def demand(wire: Wire) -> float:
    return float(wire.node.sdo[0x6062].raw) / RADIAN


def test_the_library_finds_the_mode() -> None:
    wire = operational()
    assert wire.node.is_op_mode_supported("PROFILED POSITION")
    wire.node.op_mode = "PROFILED POSITION"
    assert wire.node.sdo[0x6061].raw == PP


def test_the_demand_is_a_trapezoid_and_the_axis_follows() -> None:
    wheel = Wheel()
    wire = positioning(wheel)
    offer(wire, 1.0)
    for k in range(1, 71):
        drive(wire, wheel, 10)
        assert demand(wire) == pytest.approx(trapezoid(1.0, 2.0, 10.0, 10.0, k * 0.01), abs=2 / RADIAN)
        assert wheel.angle == pytest.approx(demand(wire), abs=0.03)
    drive(wire, wheel, 100)
    assert wheel.angle == pytest.approx(1.0, abs=0.003)
    assert status(wire) & REACHED


@pytest.mark.parametrize(("fall", "way"), [(40.0, 1.0), (5.0, 1.0), (40.0, 0.1)])
def test_it_brakes_by_its_own_ramp(fall: float, way: float) -> None:
    wheel = Wheel()
    wire = positioning(wheel)
    wire.node.sdo[0x6084].raw = round(fall * RADIAN)
    offer(wire, -way)
    for k in range(1, 90):
        drive(wire, wheel, 10)
        assert demand(wire) == pytest.approx(-trapezoid(way, 2.0, 10.0, fall, k * 0.01), abs=3 / RADIAN)


def test_the_handshake() -> None:
    """Bit 12 follows bit 4; target reached falls at once and rises when the axis has been there for 6068."""
    wheel = Wheel()
    wire = positioning(wheel)
    assert status(wire) & (REACHED | ACKNOWLEDGED) == REACHED
    wire.node.sdo[0x607A].raw = round(0.2 * RADIAN)
    drive(wire, wheel, 50)
    assert abs(wheel.angle) < 1e-3  # nothing has been offered yet
    wire.node.sdo[0x6040].raw = READY | NEW
    assert status(wire) & (REACHED | ACKNOWLEDGED) == ACKNOWLEDGED
    drive(wire, wheel, 500)
    assert status(wire) & (REACHED | ACKNOWLEDGED) == REACHED | ACKNOWLEDGED
    wire.node.sdo[0x607A].raw = 0  # without a rising bit it is no set-point
    drive(wire, wheel, 200)
    assert wheel.angle == pytest.approx(0.2, abs=0.003)
    wire.node.sdo[0x6040].raw = READY
    assert status(wire) & (REACHED | ACKNOWLEDGED) == REACHED


def test_the_dwell_before_it_counts_as_reached() -> None:
    found = []
    for dwell in (0, 200):
        wheel = Wheel()
        wire = positioning(wheel)
        wire.node.sdo[0x6068].raw = dwell
        offer(wire, 0.2)
        ticks = 0
        while not status(wire) & REACHED:
            drive(wire, wheel, 1)
            ticks += 1
        found.append(ticks)
    assert found[1] - found[0] == pytest.approx(200, abs=1)


def test_without_a_window_the_demands_arrival_counts() -> None:
    wire = positioning(Wheel())
    wire.node.sdo[0x6067].raw = 0xFFFFFFFF
    wire.node.sdo[0x6068].raw = 0
    offer(wire, 0.002)
    wire.run(100)  # the wheel is held
    assert status(wire) & REACHED
    wire.node.sdo[0x6067].raw = 5
    offer(wire, 0.004)
    wire.run(100)
    assert not status(wire) & REACHED


def test_one_after_the_other() -> None:
    """The second waits in its place, acknowledged until the first is reached; a third has no room."""
    wheel = Wheel()
    wire = positioning(wheel)
    offer(wire, 0.3)
    assert not status(wire) & ACKNOWLEDGED
    offer(wire, 0.5)
    assert status(wire) & ACKNOWLEDGED
    offer(wire, -1.0)
    highest = turned = 0.0
    while status(wire) & ACKNOWLEDGED:
        drive(wire, wheel, 1)
        highest, turned = max(highest, wheel.angle), wheel.speed
    assert highest == pytest.approx(0.3, abs=0.01)
    assert abs(turned) < 0.2
    assert not status(wire) & REACHED
    drive(wire, wheel, 500)
    assert wheel.angle == pytest.approx(0.5, abs=0.003)
    assert status(wire) & REACHED


def test_at_once_it_does_not_stop_on_the_way() -> None:
    wheel = Wheel()
    wire = positioning(wheel)
    offer(wire, 0.5)
    drive(wire, wheel, 250)
    offer(wire, 1.0, AT_ONCE)
    for _ in range(20):
        drive(wire, wheel, 10)
        assert wheel.speed > 1.8
    drive(wire, wheel, 500)
    assert wheel.angle == pytest.approx(1.0, abs=0.003)


def test_at_once_it_comes_back_and_forgets_what_waits() -> None:
    wheel = Wheel()
    wire = positioning(wheel)
    offer(wire, 0.6)
    offer(wire, 2.0)
    drive(wire, wheel, 300)
    offer(wire, 0.1, AT_ONCE)
    assert not status(wire) & ACKNOWLEDGED
    wire.node.sdo[0x6081].raw = round(0.1 * RADIAN)  # for the next set-point, not for this one
    drive(wire, wheel, 1000)
    assert wheel.angle == pytest.approx(0.1, abs=0.003)
    assert status(wire) & REACHED


def test_relative_to_the_goal_before() -> None:
    wheel = Wheel()
    wire = positioning(wheel)
    offer(wire, 0.2, RELATIVE)
    offer(wire, 0.1, RELATIVE)
    drive(wire, wheel, 800)
    assert wheel.angle == pytest.approx(0.3, abs=0.003)


def test_limits_of_place_and_speed() -> None:
    wheel = Wheel()
    wire = positioning(wheel, velocity=5.0)
    wire.node.sdo[0x607D][2].raw = round(0.4 * RADIAN)
    wire.node.sdo[0x607F].raw = round(1.0 * RADIAN)
    offer(wire, 2.0)
    assert status(wire) & LIMITED
    drive(wire, wheel, 200)
    assert wheel.speed == pytest.approx(1.0, abs=0.05)
    drive(wire, wheel, 500)
    assert wheel.angle == pytest.approx(0.4, abs=0.003)
    offer(wire, 0.2)
    assert not status(wire) & LIMITED


def test_halt_waits_and_goes_on() -> None:
    wheel = Wheel()
    wire = positioning(wheel)
    offer(wire, 1.0)
    drive(wire, wheel, 200)
    wire.node.sdo[0x6040].raw = READY | HALT
    drive(wire, wheel, 500)
    held = wheel.angle
    assert 0.2 < held < 0.7
    assert status(wire) & REACHED  # it stands
    wire.node.sdo[0x6040].raw = READY
    assert not status(wire) & REACHED
    drive(wire, wheel, 1000)
    assert wheel.angle == pytest.approx(1.0, abs=0.003)


@pytest.mark.parametrize("way", ["quick stop", "other mode"])
def test_set_points_do_not_outlive_the_mode(way: str) -> None:
    wheel = Wheel()
    wire = positioning(wheel)
    offer(wire, 1.0)
    offer(wire, 2.0)
    drive(wire, wheel, 200)
    if way == "quick stop":
        wire.node.sdo[0x6040].raw = 0x02
        drive(wire, wheel, 500)
        for word in (0x06, 0x07, READY):
            wire.node.sdo[0x6040].raw = word
    else:
        wire.node.sdo[0x607A].raw = wire.node.sdo[0x6064].raw
        wire.node.sdo[0x6060].raw = CSP
        drive(wire, wheel, 500)
        wire.node.sdo[0x6060].raw = PP
    stands = wheel.angle
    assert status(wire) & (REACHED | ACKNOWLEDGED) == REACHED
    drive(wire, wheel, 500)
    assert wheel.angle == pytest.approx(stands, abs=0.01)


def test_an_axis_that_is_jammed_says_so() -> None:
    wire = positioning(Wheel())
    wire.node.sdo[0x6065].raw = round(0.1 * RADIAN)
    offer(wire, 1.0)
    wire.run(300)
    assert wire.node.sdo[0x603F].raw == 0x8611
    assert wire.take(0x80 + NODE)[0][:2] == bytes((0x11, 0x86))
    assert status(wire) & LAGS
    wire.run(1100)
    assert wire.state() == "FAULT"


def test_a_mirrored_axis_goes_the_other_way() -> None:
    wheel = Wheel()
    wire = positioning(wheel)
    wire.node.sdo[0x607E].raw = 0xC0
    offer(wire, 0.2)
    drive(wire, wheel, 800)
    assert wheel.angle == pytest.approx(-0.2, abs=0.003)
    offer(wire, 0.1, RELATIVE)
    drive(wire, wheel, 800)
    assert wheel.angle == pytest.approx(-0.3, abs=0.003)


def test_the_bits_that_change_are_told_at_once() -> None:
    """By a TPDO that is sent on events: a master need not ask."""
    wheel = Wheel()
    wire = positioning(wheel)
    sdo = wire.node.sdo
    sdo[0x1A03][1].raw, sdo[0x1A03][0].raw = 0x60410010, 1
    sdo[0x1800 + 3][1].raw = 0x480 + NODE
    drive(wire, wheel, 2)
    wire.take(0x480 + NODE)
    offer(wire, 0.1)
    drive(wire, wheel, 600)
    words = [int.from_bytes(data, "little") & (REACHED | ACKNOWLEDGED) for data in wire.take(0x480 + NODE)]
    assert words[-1] == REACHED
    assert 0 in words
