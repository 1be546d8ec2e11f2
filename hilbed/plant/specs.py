"""Scenario block of the simulated plant: the world, and what turns its wheels."""

from __future__ import annotations

from pydantic import field_validator

from hilbed.plant.bullet_spec import BulletSpec
from hilbed.plant.chopper import Averaged, Chopper
from hilbed.plant.encoder import EncoderSpec
from hilbed.plant.gear import GEARS, Gear
from hilbed.plant.motor import MOTORS, Motor
from hilbed.plant.supply import SupplySpec
from hilbed.scene import BeaconSpec, SceneryBlock, ScenerySpec

FIRMWARE_TICK = 0.001
"""s; the control period that the loops in the drives' firmware are written for."""


class SimulatedSpec(BulletSpec):
    """A PyBullet world with beacons, and one motor, gear, chopper and encoder for each driven wheel."""

    motor: Motor = MOTORS["re35"]
    gear: Gear = GEARS["gp32c-33"]
    chopper: Chopper = Averaged()
    encoder: EncoderSpec = EncoderSpec()
    supply: SupplySpec = SupplySpec()
    beacons: list[BeaconSpec] = []
    scenery: SceneryBlock = ScenerySpec()

    @field_validator("tick")
    @classmethod
    def _firmware_can(cls, value: float) -> float:
        if value != FIRMWARE_TICK:
            raise ValueError(f"{value:g} s; the drives' firmware runs once a tick, at {FIRMWARE_TICK:g} s")
        return value
