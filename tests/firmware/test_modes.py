"""Modes, limits and units: what the bus asks for and what the loop follows, on a motor of the test's own."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from firmware_sim.ramp import approach
from tests.firmware.motor import Wheel
from tests.firmware.wire import MILLISECOND, Wire, enabled

UNIT = math.tau / 66_000  # rad/s of a count/s
FIVE = round(5 / UNIT)


def drive(wire: Wire, wheel: Wheel, ticks: int) -> None:
    """Runs drive and motor together."""
    for _ in range(ticks):
        wire.counts = wheel.counts
        wire.current = round(wheel.current * 1000)
        duty = wire.drive.tick(wire.t, wire.counts, wire.current, wire.supply)
        wire._deliver()
        wheel.tick(duty / 32767 if wire.drive.bridge_enabled else None)
        wire.t += MILLISECOND


def test_cyclic_velocity_takes_the_target_raw() -> None:
    wire = enabled()
    wire.command(0x0F, FIVE)
    wire.run(1)
    assert wire.drive.speed_ref == pytest.approx(5.0, abs=1e-4)
    wire.command(0x0F, -FIVE)
    wire.run(1)
    assert wire.drive.speed_ref == pytest.approx(-5.0, abs=1e-4)


def test_cyclic_velocity_behind_a_slew_limit() -> None:
    wire = enabled()
    wire.node.sdo[0x2013][4].raw = 20.0
    wire.command(0x0F, FIVE)
    wire.run(100)
    assert wire.drive.speed_ref == pytest.approx(2.0, rel=1e-6)


def test_profile_velocity_ramps() -> None:
    wire = enabled(mode=3)
    wire.node.sdo[0x6083].raw = round(20 / UNIT)
    wire.node.sdo[0x6084].raw = round(40 / UNIT)
    wire.command(0x0F, FIVE)
    wire.run(100)
    assert wire.drive.speed_ref == pytest.approx(2.0, rel=1e-3)
    wire.run(200)
    assert wire.drive.speed_ref == pytest.approx(5.0, rel=1e-3)
    wire.command(0x0F, -FIVE)  # brakes at 40, then runs up at 20
    wire.run(125 + 50)
    assert wire.drive.speed_ref == pytest.approx(-1.0, abs=0.03)


def test_without_a_mode_the_wheel_is_held() -> None:
    wire = enabled(mode=0)
    wire.command(0x0F, FIVE)
    wire.run(100)
    assert (wire.drive.bridge_enabled, wire.drive.speed_ref) == (True, 0.0)


@given(
    value=st.floats(-10, 10), target=st.floats(-10, 10), rise=st.floats(0.001, 1), fall=st.floats(0.001, 1)
)
def test_a_ramp_arrives_and_never_steps_too_far(
    value: float, target: float, rise: float, fall: float
) -> None:
    ticks = math.ceil((abs(value) + abs(target)) / min(rise, fall)) + 2
    for _ in range(ticks):
        after = approach(value, target, rise, fall)
        assert abs(after - value) <= (rise if abs(after) > abs(value) else fall) * (1 + 1e-9)
        assert abs(after - target) <= abs(value - target)
        value = after
    assert value == target


@pytest.mark.parametrize("mode", [3, 9])
def test_the_greatest_speed_is_kept_in_every_mode(mode: int) -> None:
    wire = enabled(mode)
    wire.command(0x0F, 2**31 - 1)
    wire.run(3000)
    assert wire.drive.speed_ref == pytest.approx(210_000 * UNIT)
    assert wire.node.sdo[0x6041].raw & 0x0800
    wire.node.sdo[0x607F].raw = 50_000
    assert wire.drive.speed_ref == pytest.approx(50_000 * UNIT)
    assert wire.node.sdo[0x606B].raw == 50_000


def test_units_and_signs_on_the_bus() -> None:
    wire, wheel = enabled(), Wheel()
    wire.command(0x0F, FIVE)
    drive(wire, wheel, 1000)
    sdo = wire.node.sdo
    assert sdo[0x606C].raw * UNIT == pytest.approx(wheel.speed, abs=0.05)
    assert sdo[0x606B].raw == FIVE
    assert sdo[0x6064].raw == wire.counts
    assert sdo[0x6078].raw == pytest.approx(wire.current / 3360 * 1000, abs=1)
    assert sdo[0x6077].raw == pytest.approx(sdo[0x6078].raw, abs=1)
    assert sdo[0x6079].raw == 24_000


def test_a_motor_that_is_mounted_mirrored() -> None:
    wire, wheel = enabled(), Wheel()
    wire.node.sdo[0x607E].raw = 0xC0
    wire.command(0x0F, FIVE)
    drive(wire, wheel, 1000)
    assert wheel.speed == pytest.approx(-5.0, abs=0.02)
    assert wire.drive.speed_ref == pytest.approx(-5.0, abs=1e-4)  # the loop's own direction
    assert wire.node.sdo[0x606C].raw * UNIT == pytest.approx(5.0, abs=0.05)
    assert wire.node.sdo[0x6064].raw == -wire.counts
    assert wire.node.sdo[0x6078].raw > 0


def test_status_bits_in_profile_velocity() -> None:
    wire, wheel = enabled(mode=3), Wheel()
    word = wire.node.sdo[0x6041]
    assert word.raw & 0x1400 == 0x1400  # at zero, as asked
    wire.command(0x0F, FIVE)
    drive(wire, wheel, 100)
    assert word.raw & 0x1400 == 0
    drive(wire, wheel, 900)
    assert word.raw & 0x1400 == 0x0400


def test_status_bits_in_cyclic_velocity() -> None:
    wire = enabled()
    assert wire.node.sdo[0x6041].raw & 0x1000  # follows
    wire.command(0x10F)
    assert not wire.node.sdo[0x6041].raw & 0x1000  # halted
    wire.supply = 40
    wire.run(1)
    assert not wire.node.sdo[0x6041].raw & 0x0010


def test_the_whole_drive_meets_the_published_numbers() -> None:
    wire, wheel = enabled(), Wheel()
    wire.command(0x0F, FIVE)
    drive(wire, wheel, 1000)
    wheel.load = 3.0
    speeds = []
    for _ in range(500):
        drive(wire, wheel, 1)
        speeds.append(wheel.speed)
    assert 5.0 - min(speeds) <= 0.25
    assert all(abs(speed - 5.0) <= 0.1 for speed in speeds[80:])


def test_a_rolling_wheel_is_taken_over_without_a_bump() -> None:
    wire, wheel = enabled(mode=3), Wheel()
    wire.command(0x0F, FIVE)
    drive(wire, wheel, 1000)
    wire.command(0x00)  # coasts
    drive(wire, wheel, 100)
    rolling = wheel.speed
    assert rolling > 2
    for word in (0x06, 0x07, 0x0F):
        wire.command(word, round(rolling / UNIT))
    drive(wire, wheel, 1)
    assert wire.drive.speed_ref == pytest.approx(rolling, abs=0.1)
    drive(wire, wheel, 20)
    assert wheel.speed == pytest.approx(rolling, abs=0.15)


def test_changing_the_loop_while_it_runs_is_smooth() -> None:
    wire, wheel = enabled(), Wheel()
    wire.command(0x0F, FIVE)
    drive(wire, wheel, 1000)
    for kind in (1, 2, 0):
        wire.node.sdo[0x2010][1].raw = kind
        drive(wire, wheel, 5)
        assert wheel.speed == pytest.approx(5.0, abs=0.15)
        drive(wire, wheel, 500)


@pytest.mark.parametrize("turn", [33_000, 132_000])
def test_another_encoder(turn: int) -> None:
    wire = enabled()
    wire.node.sdo[0x2001].raw = turn
    wire.command(0x0F, turn)
    wire.run(1)
    assert wire.drive.speed_ref == pytest.approx(math.tau, abs=1e-4)
