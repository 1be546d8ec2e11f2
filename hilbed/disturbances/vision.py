"""What the camera sees that is not there, and when it sees nothing."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from hilbed.disturbances.schedule import STEADY, Disturbance, DisturbanceBase
from hilbed.effects import Effects, Surroundings
from hilbed.types import Nanos, Rng


class SpuriousAzimuths(DisturbanceBase):
    """False azimuths: `size` of them in a frame on the average (Poisson)."""

    kind: Literal["spurious_azimuths"] = "spurious_azimuths"
    size: Annotated[float, Field(ge=0, le=1000)]


class CameraLoss(DisturbanceBase):
    """The camera delivers no frames."""

    kind: Literal["camera_loss"] = "camera_loss"


def spurious_azimuths(spec: SpuriousAzimuths, _: int, __: Rng) -> Disturbance:
    """Returns the disturbance that adds false azimuths to the frames."""

    def apply(_: Nanos, __: Surroundings, effects: Effects) -> Nanos:
        effects.spurious += spec.size
        return STEADY

    return apply


def camera_loss(_: CameraLoss, __: int, ___: Rng) -> Disturbance:
    """Returns the disturbance that blinds the camera."""

    def apply(_: Nanos, __: Surroundings, effects: Effects) -> Nanos:
        effects.blind = True
        return STEADY

    return apply
