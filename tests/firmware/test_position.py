"""Position mode: an axis that follows targets, on a motor of the test's own."""

from __future__ import annotations

import math

import pytest

from tests.firmware.motor import COUNTS, Wheel
from tests.firmware.test_modes import drive
from tests.firmware.wire import NODE, Wire, operational

CSP, HOMING = 8, 6
RADIAN = COUNTS / math.tau
LIMITED, ATTAINED, FOLLOWS = 0x0800, 0x1000, 0x1000


def following(wire: Wire, wheel: Wheel, targets: list[int]) -> list[float]:
    """Sends a target every 10 ms; returns where the axis is (counts) when each of them should be reached."""
    found = []
    for target in targets:
        wire.command(0x0F, target)
        drive(wire, wheel, 10)
        found.append(wheel.angle * RADIAN)
    return found


def position_drive() -> Wire:
    """A drive that holds its position, with RPDO1 as a steering axis has it."""
    wire = operational()
    sdo = wire.node.sdo
    sdo[0x1400][1].raw = 0x80000200 + NODE
    sdo[0x1600][0].raw = 0
    sdo[0x1600][2].raw = 0x607A0020
    sdo[0x1600][0].raw = 2
    sdo[0x1400][1].raw = 0x200 + NODE
    sdo[0x6060].raw = CSP
    for word in (0x06, 0x07, 0x0F):
        wire.command(word)
    return wire


def test_it_follows_targets_that_move_steadily() -> None:
    """What the speed loop leaves behind, fed forward, is less than a hundredth of the way."""
    wire, wheel = position_drive(), Wheel()
    targets = [round(0.5 * k * 0.01 * RADIAN) for k in range(1, 201)]  # 0.5 rad/s
    found = following(wire, wheel, targets)
    assert max(abs(a - b) for a, b in zip(found[50:], targets[50:], strict=True)) < 0.01 * RADIAN
    found = following(wire, wheel, [targets[-1]] * 100)
    assert found[-1] == pytest.approx(targets[-1], abs=0.002 * RADIAN)
    assert wire.node.sdo[0x6041].raw & FOLLOWS
    assert wire.node.sdo[0x6062].raw == targets[-1]
    assert wire.node.sdo[0x60F4].raw == pytest.approx(targets[-1] - wheel.counts, abs=1)


def test_a_jump_is_taken_at_the_highest_speed_without_much_overshoot() -> None:
    wire, wheel = position_drive(), Wheel()
    wire.node.sdo[0x607F].raw = round(2.0 * RADIAN)
    goal = round(1.0 * RADIAN)
    found = following(wire, wheel, [goal] * 100)
    assert found[24] == pytest.approx(0.5 * RADIAN, abs=0.06 * RADIAN)  # 2 rad/s for 0.25 s
    assert max(found) < 1.02 * goal
    assert found[-1] == pytest.approx(goal, abs=0.002 * RADIAN)


def test_limits_of_the_position() -> None:
    wire, wheel = position_drive(), Wheel()
    wire.node.sdo[0x607D][1].raw = round(-0.1 * RADIAN)
    wire.node.sdo[0x607D][2].raw = round(0.2 * RADIAN)
    found = following(wire, wheel, [round(1.0 * RADIAN)] * 100)
    assert found[-1] == pytest.approx(0.2 * RADIAN, abs=0.002 * RADIAN)
    assert wire.node.sdo[0x6041].raw & LIMITED
    found = following(wire, wheel, [round(-1.0 * RADIAN)] * 100)
    assert found[-1] == pytest.approx(-0.1 * RADIAN, abs=0.002 * RADIAN)


@pytest.mark.parametrize(("reaction", "powered"), [(2, True), (0, False)])
def test_an_axis_that_is_jammed_says_so(reaction: int, powered: bool) -> None:
    wire = position_drive()
    wire.node.sdo[0x605E].raw = reaction
    wire.node.sdo[0x6065].raw = round(0.1 * RADIAN)
    for k in range(1, 20):
        wire.command(0x0F, round(0.01 * k * RADIAN))
        wire.run(10)
        if wire.drive.faulted:
            break
    assert k == pytest.approx(11, abs=1)
    assert wire.node.sdo[0x603F].raw == 0x8611
    wire.run(1100)
    assert wire.state() == "FAULT"
    assert not wire.drive.bridge_enabled
    assert powered or wire.duty == 0
    emergencies = wire.take(0x80 + NODE)
    assert emergencies[0][:3] == bytes((0x11, 0x86, 0x21))


def test_home_is_where_the_axis_is_told_to_be() -> None:
    wire, wheel = operational(), Wheel()
    wheel.angle = 0.3
    drive(wire, wheel, 100)
    wire.node.sdo[0x6060].raw = HOMING
    for word in (0x06, 0x07, 0x0F):
        wire.node.sdo[0x6040].raw = word
    assert not wire.node.sdo[0x6041].raw & ATTAINED
    wire.node.sdo[0x607C].raw = 1000
    wire.node.sdo[0x6040].raw = 0x1F
    drive(wire, wheel, 5)
    assert wire.node.sdo[0x6041].raw & ATTAINED
    assert wire.node.sdo[0x6064].raw == 1000
    wire.node.sdo[0x607F].raw = round(2.0 * RADIAN)
    wire.node.sdo[0x607A].raw = 1000 + round(0.2 * RADIAN)
    wire.node.sdo[0x6060].raw = CSP
    drive(wire, wheel, 1500)
    assert wheel.angle == pytest.approx(0.5, abs=0.002)


def test_a_mirrored_axis_goes_the_other_way() -> None:
    wire, wheel = position_drive(), Wheel()
    wire.node.sdo[0x607E].raw = 0xC0
    following(wire, wheel, [round(0.2 * RADIAN)] * 100)
    assert wheel.angle == pytest.approx(-0.2, abs=0.002)
    assert wire.node.sdo[0x6064].raw == pytest.approx(0.2 * RADIAN, abs=0.002 * RADIAN)


def test_quick_stop_brakes_and_halt_holds() -> None:
    wire, wheel = position_drive(), Wheel()
    wire.node.sdo[0x607F].raw = round(2.0 * RADIAN)
    following(wire, wheel, [round(3.0 * RADIAN)] * 20)
    wire.command(0x010F, round(3.0 * RADIAN))
    drive(wire, wheel, 500)
    assert abs(wheel.speed) < 0.02
    wire.command(0x0F, round(3.0 * RADIAN))
    drive(wire, wheel, 200)
    assert wheel.speed == pytest.approx(2.0, abs=0.1)
    wire.command(0x02)
    drive(wire, wheel, 300)
    assert wire.state() == "SWITCH ON DISABLED"
    assert abs(wheel.speed) < 0.05


def test_gains_change_without_a_bump() -> None:
    wire, wheel = position_drive(), Wheel()
    following(wire, wheel, [round(0.2 * RADIAN)] * 100)
    wire.node.sdo[0x2014].raw = 30.0
    found = following(wire, wheel, [round(0.2 * RADIAN)] * 20)
    assert found == pytest.approx([0.2 * RADIAN] * 20, abs=0.002 * RADIAN)
