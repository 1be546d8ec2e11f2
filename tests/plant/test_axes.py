"""Axes and the world: mounted the other way round, and a wheel that is led by a speed."""

from __future__ import annotations

from pathlib import Path

import pytest

from hilbed.can.terminal import Answer
from hilbed.cost import Cost
from hilbed.effects import Effects
from hilbed.plant.axes import EcuAxis, MirroredAxis
from hilbed.plant.bullet import BulletWorld
from hilbed.plant.chopper import Averaged
from hilbed.plant.drivetrain import DriveTrain, reflected_inertia
from hilbed.plant.encoder import Encoder, EncoderSpec
from hilbed.plant.gear import GEARS
from hilbed.plant.motor import MOTORS
from hilbed.plant.specs import SimulatedSpec
from hilbed.plant.urdf import Behind, diffdrive
from hilbed.scenario import files
from hilbed.types import Pose

MOTOR, GEAR = MOTORS["re35"], GEARS["gp32c-33"]


class Firmware:
    """Answers with a duty, and keeps what it was shown."""

    def __init__(self, duty: int) -> None:
        self.answer = Answer(duty, True, False, 0, 2_000_000 if duty > 0 else -2_000_000)
        self.shown: tuple[int, int, int] | None = None

    def present(self, counts: int, current: int, supply: int) -> None:
        self.shown = counts, current, supply


def axis(firmware: Firmware) -> EcuAxis:
    train = DriveTrain(MOTOR, GEAR, Averaged(), 1e-3)
    return EcuAxis("left", train, Encoder(EncoderSpec(resolution=1000), 1e-3), firmware)


def test_a_mirrored_drive_does_with_the_opposite_duty_the_same_to_the_wheel() -> None:
    plain, turned = Firmware(16_000), Firmware(-16_000)
    one, other = axis(plain), MirroredAxis(axis(turned))
    angle = 0.0
    for k in range(30):
        torques = []
        for each in (one, other):
            each.present(angle, 96)
            torques.append(each.step(k * 1_000_000, angle, 1.5, 24.0, 96))
        assert torques[0] == torques[1] > 0.0 or k == 0
        assert (one.current, one.duty, one.speed_ref) == (other.current, other.duty, other.speed_ref)
        assert one.supply_current == other.supply_current
        angle += 1.5e-3
    assert plain.shown is not None
    assert turned.shown is not None
    assert turned.shown[1] == -plain.shown[1]
    assert abs(turned.shown[0] + plain.shown[0]) <= 1  # counts are rounded down in either direction


def world(friction: float) -> BulletWorld:
    spec = SimulatedSpec(kind="bullet", friction=friction)
    body = diffdrive(files.resolve("package:urdf/diffdrive.urdf", Path()), 0.1, 0.4)
    return BulletWorld(body, spec, Pose(0.0, 0.0, 0.0), Behind(reflected_inertia(MOTOR, GEAR)), Cost())


def lead(friction: float, torque: float, ticks: int, load: float = 0.0) -> BulletWorld:
    """Leads both wheels to 4 rad/s by no more than a torque."""
    moved, effects = world(friction), Effects([friction, friction])
    effects.load_torque[:] = [load, load]
    moved.targets[:] = [4.0, 4.0]
    for _ in range(ticks):
        moved.step([0.0, 0.0], [torque, torque], effects)
    return moved


@pytest.mark.parametrize("load", [0.0, 2.0])
def test_a_led_wheel_has_its_speed_whatever_loads_it(load: float) -> None:
    moved = lead(0.8, 7.0, 600, load)
    assert moved.speeds == pytest.approx([4.0, 4.0], abs=1e-6)
    assert moved.pose.x == pytest.approx(0.4 * 0.6, rel=0.2)
    moved.close()


def test_it_is_led_by_no_more_than_the_torque() -> None:
    """From rest, v̇ = 2 τ / R / (m + 2 J / R²): far from 4 rad/s after a tenth of a second."""
    moved = lead(0.8, 0.5, 100)
    assert 0.1 < moved.speeds[0] < 2.0
    twice = lead(0.8, 1.0, 100)
    assert twice.speeds[0] == pytest.approx(2.0 * moved.speeds[0], rel=0.05)
    moved.close()
    twice.close()


def test_on_ice_it_spins() -> None:
    moved = lead(0.01, 7.0, 600)
    assert moved.speeds == pytest.approx([4.0, 4.0], abs=1e-6)
    assert moved.slips[0] > 0.3
    moved.close()
