"""What loads a drive or starves it."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import model_validator

from hilbed.clock import seconds
from hilbed.disturbances.schedule import STEADY, Disturbance, DisturbanceBase, drawn
from hilbed.effects import Effects, Surroundings
from hilbed.spec import Finite, NonNegative, Positive
from hilbed.types import Nanos, Rng

IMPULSE_LENGTH = 0.02
"""s; an impulse without a length is a pulse this long, a blow that the 1 ms tick still resolves."""


class LoadTorque(DisturbanceBase):
    """A torque of `size` ± `spread` N m on a wheel's axle, positive against forward rotation.

    shape: step (at once), ramp (rises linearly to `size` over `rise` s, then stays), impulse (one pulse of
    `length`, 20 ms where none is given).
    """

    kind: Literal["load_torque"] = "load_torque"
    drive: str
    size: Finite
    spread: NonNegative = 0.0
    shape: Literal["step", "ramp", "impulse"] = "step"
    rise: Positive = 1.0

    @model_validator(mode="before")
    @classmethod
    def _impulse_is_short(cls, given: Any) -> Any:
        if isinstance(given, dict) and given.get("shape") == "impulse":
            return {"length": IMPULSE_LENGTH, **given}
        return given


class SupplySag(DisturbanceBase):
    """Takes `size` ± `spread` V off the supply's open-circuit voltage."""

    kind: Literal["supply_sag"] = "supply_sag"
    size: NonNegative
    spread: NonNegative = 0.0


def load_torque(spec: LoadTorque, wheel: int, rng: Rng) -> Disturbance:
    """Returns the disturbance that loads the wheel with that index."""
    size = drawn(spec.size, spec.spread, rng)

    def apply(since: Nanos, _: Surroundings, effects: Effects) -> Nanos:
        part = min(1.0, seconds(since) / spec.rise) if spec.shape == "ramp" else 1.0
        effects.load_torque[wheel] += part * size
        return STEADY if part == 1.0 else 0

    return apply


def supply_sag(spec: SupplySag, _: int, rng: Rng) -> Disturbance:
    """Returns the disturbance that lowers the supply."""
    size = drawn(spec.size, spec.spread, rng)

    def apply(_: Nanos, __: Surroundings, effects: Effects) -> Nanos:
        effects.supply_drop += size
        return STEADY

    return apply
