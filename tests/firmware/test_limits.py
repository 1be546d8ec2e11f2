"""What the drive keeps to, whatever the bus says: speed, current, ramps, and protection that stays on."""

from __future__ import annotations

import math
import random
import struct

import pytest

from firmware_sim import Frame
from tests.firmware.motor import Wheel
from tests.firmware.test_modes import FIVE, UNIT, drive
from tests.firmware.wire import MILLISECOND, NODE, Wire, enabled

GREATEST = 210_000 * UNIT  # 607F as it is at power-on
LIMIT = 10.0  # A, 2013:1


def write(index: int, sub: int, data: bytes) -> Frame:
    """Returns an expedited download, for a client that does not wait for the answer."""
    head = 0x23 | 4 - len(data) << 2
    return Frame(0x600 + NODE, struct.pack("<BHB", head, index, sub) + data.ljust(4, b"\0"))


@pytest.mark.parametrize("mode", [3, 9])
@pytest.mark.parametrize("polarity", [0x00, 0x40])
@pytest.mark.parametrize("target", [2**31 - 1, -(2**31)])
def test_no_target_is_beyond_the_greatest_speed(mode: int, polarity: int, target: int) -> None:
    wire = enabled(mode)
    wire.node.sdo[0x607E].raw = polarity
    wire.command(0x0F, target)
    wire.run(4000)
    sign = math.copysign(1.0, target) * (-1 if polarity else 1)
    assert wire.drive.speed_ref == pytest.approx(sign * GREATEST, rel=1e-12)
    assert wire.node.sdo[0x6041].raw & 0x0800  # internal limit active


def test_a_lower_limit_acts_at_once() -> None:
    wire = enabled()
    wire.command(0x0F, FIVE)
    wire.run(1)
    wire.node.sdo[0x607F].raw = round(1 / UNIT)
    assert wire.drive.speed_ref == pytest.approx(1.0, abs=1e-4)


def test_an_encoder_of_more_counts_lowers_it_too() -> None:
    """607F is in counts: at twice as many a turn it is half as fast."""
    wire = enabled()
    wire.command(0x0F, 210_000)
    wire.run(1)
    wire.node.sdo[0x2001].raw = 132_000
    assert wire.drive.speed_ref == pytest.approx(GREATEST / 2)
    wire.run(1)
    assert wire.drive.speed_ref == pytest.approx(GREATEST / 2)


def test_a_wheel_that_is_pushed_faster_is_taken_over_at_the_greatest_speed() -> None:
    wire = enabled()
    wire.command(0x00)
    wire.run(200, counts_per_tick=400)  # 38 rad/s
    for word in (0x06, 0x07, 0x0F):
        wire.command(word, FIVE)
        assert abs(wire.drive.speed_ref) <= GREATEST


def test_the_current_of_a_motor_under_any_targets() -> None:
    """Above the limit by what speed is gained while the speedmeter lags: 3 ms at the acceleration of 10 A."""
    source, wire, wheel = random.Random(2), enabled(), Wheel()
    most = 0.0
    for _ in range(400):
        wire.command(0x0F, source.randrange(-(2**31), 2**31))
        for _ in range(10):
            wheel.load = source.uniform(-3.0, 3.0)
            drive(wire, wheel, 1)
            most = max(most, abs(wheel.current))
    assert 0.9 * LIMIT < most < 1.15 * LIMIT
    assert wire.state() == "OPERATION ENABLED"


@pytest.mark.parametrize("limit", [0.0, 2.0, 10.0])
def test_a_wheel_that_is_jammed_draws_no_more_than_the_limit(limit: float) -> None:
    """A stalled motor: i = U d / R."""
    wire = enabled()
    wire.node.sdo[0x2013][1].raw = limit
    wire.command(0x0F, FIVE)
    wire.run(500)
    assert wire.duty / 32767 * 24.0 / 0.583 == pytest.approx(limit, abs=24.0 / 0.583 / 32767)
    assert wire.node.sdo[0x6041].raw & 0x0800
    wire.command(0x00, 0)
    assert not wire.node.sdo[0x6041].raw & 0x0800


@pytest.mark.parametrize("target", [FIVE, -FIVE])
def test_the_whole_supply_is_a_duty_of_32767(target: int) -> None:
    wire = enabled()
    wire.supply = 24  # 6 V, which the limit of 10 A leaves to the motor
    wire.node.sdo[0x2013][3].raw = 0.0  # no undervoltage
    wire.node.sdo[0x2013][1].raw = 15.0
    wire.command(0x0F, target)
    wire.run(1000)
    assert wire.duty == math.copysign(32767, target)


def test_a_drive_that_lost_its_encoder_turns_no_faster_than_the_limit_of_a_stalled_one_allows() -> None:
    """It believes the wheel to stand, so its duty is that of a stalled motor: w ≤ R i / K = 6.05 rad/s."""
    wire, wheel = enabled(), Wheel()
    wire.command(0x0F, FIVE)
    for _ in range(3000):
        wire.run(1)
        wheel.tick(wire.duty / 32767)
    assert 4.0 < wheel.speed < 0.583 * LIMIT / 0.9636


def test_tuning_at_every_tick_does_not_hold_up_a_stop() -> None:
    wire, wheel = enabled(), Wheel()
    wire.command(0x0F, FIVE)
    drive(wire, wheel, 1000)
    assert wheel.speed > 4.9
    wire.command(0x02)
    for _ in range(150):  # 5 rad/s at 50 rad/s² are 100 ms
        wire.drive.on_frame(wire.t, write(0x2000, 0, b"x"))
        before = wire.drive.speed_ref
        drive(wire, wheel, 1)
        assert 0.0 <= wire.drive.speed_ref <= before
    assert abs(wheel.speed) < 0.1
    assert wire.state() == "SWITCH ON DISABLED"


def test_tuning_at_every_tick_does_not_switch_protection_off() -> None:
    wire = enabled()
    wire.supply = 40
    for _ in range(5):
        wire.drive.on_frame(wire.t, write(0x2000, 0, b"x"))
        wire.run(1)
    assert wire.state() == "FAULT"


def test_commands_that_come_late_all_at_once_leave_the_last_one() -> None:
    """A queue that has piled up: only the newest target before a SYNC acts."""
    wire = enabled()
    for target in (FIVE, -FIVE, 2 * FIVE, 0):
        word = (0x0F).to_bytes(2, "little") + target.to_bytes(4, "little", signed=True)
        wire.drive.on_frame(wire.t, Frame(0x200 + NODE, word))
    wire.drive.on_frame(wire.t, Frame(0x080))
    wire.run(1)
    assert wire.drive.speed_ref == 0.0


def test_a_babbling_master_cannot_keep_a_drive_alive_that_has_lost_its_heartbeat() -> None:
    wire = enabled()
    wire.node.sdo[0x1016][1].raw = 0x7F_0032
    wire.command(0x0F, FIVE)
    wire.send_message(0x77F, b"\x05")
    for _ in range(200):
        wire.command(0x0F, FIVE)
        wire.run(1)
    assert wire.state() == "SWITCH ON DISABLED"
    assert wire.t == pytest.approx(201 * MILLISECOND, abs=MILLISECOND)


def test_repeating_a_command_does_not_begin_its_ramp_again() -> None:
    wire = enabled()
    wire.command(0x0F, FIVE)
    wire.run(1)
    for _ in range(600):  # 5 rad/s at 10 rad/s² are 500 ms
        wire.command(0x07, FIVE)
        wire.run(1)
    assert wire.state() == "SWITCHED ON"


def test_a_wheel_that_rests_at_the_lowest_count_mirrored() -> None:
    """−2³¹ has no counterpart: it is its own, as the counter wraps."""
    wire = Wire()
    wire.counts = -(2**31)
    wire.run(1)
    wire.node.sdo[0x607E].raw = 0x80
    assert wire.node.sdo[0x6064].raw == -(2**31)
