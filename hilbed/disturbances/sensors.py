"""Sensors that deliver nothing, or what is no number."""

from __future__ import annotations

from typing import Literal

from hilbed.disturbances.schedule import STEADY, Disturbance, DisturbanceBase
from hilbed.effects import Effects, Surroundings
from hilbed.types import Nanos, Rng


class SensorLoss(DisturbanceBase):
    """A sensor that is no camera takes no samples: its markers are hidden, its satellites set."""

    kind: Literal["sensor_loss"] = "sensor_loss"
    sensor: str


class SensorNan(DisturbanceBase):
    """A sensor that is no camera delivers NaN, on time; estimators count such readings and go on."""

    kind: Literal["sensor_nan"] = "sensor_nan"
    sensor: str


def sensor_loss(spec: SensorLoss, _: int, __: Rng) -> Disturbance:
    """Returns the disturbance that silences a sensor."""

    def apply(_: Nanos, __: Surroundings, effects: Effects) -> Nanos:
        effects.lost.add(spec.sensor)
        return STEADY

    return apply


def sensor_nan(spec: SensorNan, _: int, __: Rng) -> Disturbance:
    """Returns the disturbance that makes a sensor's readings NaN."""

    def apply(_: Nanos, __: Surroundings, effects: Effects) -> Nanos:
        effects.broken.add(spec.sensor)
        return STEADY

    return apply
