"""Scenario block of the particle filter."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from hilbed.spec import NonNegative, Positive, Spec

Deviation = Annotated[float, Field(ge=1e-6, le=1e6)]


class ParticleFilterSpec(Spec):
    """Monte Carlo localisation by odometry and a sensor of position or pose: Lages & Alves (2017).

    particles: M; side (m): of the square that the first cloud fills; along_noise (m/m) and turn_noise
    (rad/m): σ_t and σ_D, standard deviations per way in one period; position_std (m) and yaw_std (rad): in
    place of what a reading says of itself; recover_after: readings in a row that no particle explains, after
    which the cloud is drawn anew round the last of them, null for never; memory (s): how old a reading may
    be. The cloud is resampled at every reading, as in the paper.
    """

    kind: Literal["particles"] = "particles"
    particles: Annotated[int, Field(ge=1, le=1_000_000)] = 900
    side: NonNegative = 1.0
    along_noise: NonNegative = 0.005
    turn_noise: NonNegative = 0.1745
    resampling: Literal["multinomial", "systematic"] = "multinomial"
    position_std: Deviation | None = None
    yaw_std: Deviation | None = None
    recover_after: Annotated[int, Field(ge=1)] | None = 5
    memory: Annotated[Positive, Field(le=60)] = 1.0
