"""The shaft against closed forms; the whole drive, commanded by frames, against the motor's data sheet."""

from __future__ import annotations

import struct
from math import pi, tau

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed.can.sdo import download_frame
from hilbed.drive.desk import TICK, Build, Desk
from hilbed.drive.shaft import Shaft
from hilbed.plant.gear import GEARS
from hilbed.plant.motor import MOTORS
from hilbed.types import Frame

DT = 1e-3
MOTOR, GEAR = MOTORS["re35"], GEARS["gp32c-33"]


@given(st.floats(1e-3, 10.0), st.floats(-5.0, 5.0), st.floats(-5.0, 5.0))
def test_a_constant_torque_accelerates(inertia: float, torque: float, load: float) -> None:
    shaft = Shaft(inertia, load, 0.0, DT)
    for _ in range(100):
        shaft.step(torque)
    rate = (torque - load) / inertia
    assert shaft.speed == pytest.approx(rate * 0.1, rel=1e-9, abs=1e-12)
    assert shaft.angle == pytest.approx(0.5 * rate * 0.1**2, rel=1e-9, abs=1e-12)


@given(st.floats(0.1, 5.0), st.floats(-1.0, 1.0))
def test_dry_friction_holds_what_is_below_it(friction: float, share: float) -> None:
    shaft = Shaft(0.05, 0.0, friction, DT)
    for _ in range(10):
        shaft.step(0.999 * share * friction)
    assert (shaft.speed, shaft.angle) == (0.0, 0.0)


@given(st.floats(-20.0, 20.0), st.floats(0.1, 2.0))
def test_dry_friction_stops_and_does_not_turn_back(speed: float, friction: float) -> None:
    """From ω it takes J ω / τ to rest, over J ω² / 2 τ."""
    shaft = Shaft(0.05, 0.0, friction, DT)
    shaft.speed = speed
    for _ in range(int(0.05 * abs(speed) / friction / DT) + 2):
        shaft.step(0.0)
    assert shaft.speed == 0.0
    assert shaft.angle * (1 if speed > 0 else -1) == pytest.approx(
        0.05 * speed**2 / 2 / friction, abs=2 * DT * abs(speed)
    )


class Commanded:
    """A drive on a desk, enabled in PV by SDO; `seen` is what it sends."""

    def __init__(self, **build: float) -> None:
        self.desk = Desk(Build(1, **build))  # type: ignore[arg-type]
        self.seen: list[Frame] = []
        self.t = 0
        self.tick()
        self.write(0x6060, 3, 1)
        for word in (0x06, 0x07, 0x0F):
            self.write(0x6040, word, 2)

    def write(self, index: int, value: int, size: int) -> None:
        self.tick(download_frame(1, index, 0, value.to_bytes(size, "little", signed=value < 0)))
        answer = next(frame for frame in self.seen if frame.id == 0x581)
        assert answer.data[0] == 0x60, answer

    def tick(self, *frames: Frame) -> None:
        self.seen = self.desk.tick(self.t, frames)
        self.t += TICK

    def settle(self, speed: float, ticks: int = 1500) -> None:
        self.write(0x60FF, round(speed / tau * 66_000), 4)
        for _ in range(ticks):
            self.tick()


@pytest.mark.parametrize("load", [0.0, 1.5, -0.5])
def test_at_steady_speed_the_current_carries_the_load(load: float) -> None:
    """η N K_t i = N b ω η + friction + load, the motor driving."""
    drive = Commanded(load=load)
    drive.settle(5.0)
    means = []
    for _ in range(200):
        drive.tick()
        means.append(drive.desk.current)
    assert drive.desk.shaft.speed == pytest.approx(5.0, abs=0.02)
    shaft_torque = (load + MOTOR.coulomb * GEAR.ratio) / (
        GEAR.ratio * (GEAR.efficiency if load >= 0.0 else 1.0 / GEAR.back_efficiency)
    )
    amperes = (shaft_torque + MOTOR.viscous * GEAR.ratio * 5.0) / MOTOR.torque_constant
    assert sum(means) / len(means) == pytest.approx(amperes, rel=0.02, abs=0.01)


@pytest.mark.parametrize("inertia", [0.02, 0.2])
def test_it_comes_to_speed_and_stops_with_any_inertia(inertia: float) -> None:
    drive = Commanded(inertia=inertia)
    drive.settle(-8.0, 2500)
    assert drive.desk.shaft.speed == pytest.approx(-8.0, abs=0.05)
    drive.write(0x6040, 0x02, 2)  # quick stop
    for _ in range(400):
        drive.tick()
    assert drive.desk.shaft.speed == 0.0
    assert not drive.desk.firmware.bridge_enabled


def test_a_load_pulls_a_shaft_that_nothing_holds() -> None:
    desk = Desk(Build(1, load=3.0))
    for k in range(500):
        desk.tick(k * TICK, ())
    assert desk.shaft.speed < -1.0


def test_what_its_maker_has_stored_survives_a_reset() -> None:
    """Another encoder: the same words on the bus mean other numbers, the defaults in rad/s stay."""
    desk = Desk(Build(1, counts=8000))
    desk.tick(0, ())
    for k, frame in enumerate((Frame(0x000, b"\x81\x01"), Frame(0x601, b"\x40\x01\x20\0\0\0\0\0")), start=1):
        sent = desk.tick(k * TICK, (frame,))
    (answer,) = (frame for frame in sent if frame.id == 0x581)
    assert struct.unpack("<I", answer.data[4:]) == (8000,)
    assert desk.firmware._axis.settings.max_speed == pytest.approx(210_000 / 66_000 * 2 * pi, rel=1e-4)


@pytest.mark.parametrize("angle", [-0.2, 0.4])
def test_a_steering_axis_finds_its_home_switch(angle: float) -> None:
    """Method 19, by SDO: afterwards the position is the angle from the switch."""
    desk = Desk(Build(5, angle=angle, switch=0.1))
    orders = [(0x6098, 1, 19), (0x6060, 1, 6), *((0x6040, 2, word) for word in (0x06, 0x07, 0x0F, 0x1F))]
    for k in range(6000):
        order = orders[k - 1] if 0 < k <= len(orders) else None  # its power comes with the first tick
        frames = (
            [] if order is None else [download_frame(5, order[0], 0, order[2].to_bytes(order[1], "little"))]
        )
        desk.tick(k * TICK, frames)
    position = struct.unpack("<i", _asked(desk, 0x6064))[0] / 66_000 * tau
    assert desk.shaft.angle - position == pytest.approx(0.1, abs=3e-4)
    assert desk.shaft.angle == pytest.approx(0.1, abs=0.02)


def _asked(desk: Desk, index: int) -> bytes:
    """Returns the four bytes that an object holds."""
    request = Frame(0x605, bytes((0x40, index & 0xFF, index >> 8, 0, 0, 0, 0, 0)))
    sent = desk.tick(10_000 * TICK, [request])
    return next(frame.data for frame in sent if frame.id == 0x585)[4:]
