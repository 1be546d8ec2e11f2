"""Scenario block of the simulated plant: the world, and what turns its wheels."""

from __future__ import annotations

from typing import NamedTuple

from pydantic import field_validator

from hilbed.plant.bullet_spec import BulletSpec
from hilbed.plant.chopper import Averaged, Chopper
from hilbed.plant.drivetrain import reflected_inertia
from hilbed.plant.encoder import EncoderSpec
from hilbed.plant.gear import GEARS, Gear, GearSpec
from hilbed.plant.motor import MOTORS, Motor, MotorSpec
from hilbed.plant.supply import SupplySpec
from hilbed.scene import BeaconSpec, SceneryBlock, ScenerySpec
from hilbed.spec import Finite, Listed, NonNegative, Spec

STEERING = "steering"
"""Name of the drive that holds an angle."""

FIRMWARE_TICK = 0.001
"""s; the control period that the loops in the drives' firmware are written for."""


class Machine(NamedTuple):
    """What turns one wheel or axis."""

    motor: MotorSpec
    gear: GearSpec
    encoder: EncoderSpec

    @property
    def inertia(self) -> float:
        """Of rotor and gear as the wheel feels it, kg m²."""
        return reflected_inertia(self.motor, self.gear)


class SteeringSpec(Spec):
    """A tricycle's steering axis, as far as it is not what the wheels have.

    motor, gear, encoder: null as the wheels'; start: rad, where the axis stands as its drive is powered;
    switch: rad, from which angle on its home switch is on, null for none.
    """

    motor: Motor | None = None
    gear: Gear | None = None
    encoder: EncoderSpec | None = None
    start: Finite = 0.0
    switch: Finite | None = None


class SimulatedSpec(BulletSpec):
    """A PyBullet world with beacons, and one motor, gear, chopper and encoder for each driven wheel.

    steering: what a steering axis has of its own, null: the same as a wheel;
    start_std (m, m, rad): how wrong the estimator is told the start, standard deviations, drawn once.
    """

    motor: Motor = MOTORS["re35"]
    gear: Gear = GEARS["gp32c-33"]
    chopper: Chopper = Averaged()
    encoder: EncoderSpec = EncoderSpec()
    supply: SupplySpec = SupplySpec()
    steering: SteeringSpec | None = None
    beacons: list[BeaconSpec] = []
    scenery: SceneryBlock = ScenerySpec()
    start_std: Listed[tuple[NonNegative, NonNegative, NonNegative]] = (0.0, 0.0, 0.0)

    def machine(self, drive: str) -> Machine:
        """Returns what turns a drive's wheel or axis, by its name."""
        own = SteeringSpec() if drive != STEERING or self.steering is None else self.steering
        return Machine(own.motor or self.motor, own.gear or self.gear, own.encoder or self.encoder)

    @field_validator("tick")
    @classmethod
    def _firmware_can(cls, value: float) -> float:
        if value != FIRMWARE_TICK:
            raise ValueError(f"{value:g} s; the drives' firmware runs once a tick, at {FIRMWARE_TICK:g} s")
        return value
