"""The world a scenario asks for; without PyBullet, so that checking a scenario stays quick."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from hilbed.spec import NonNegative, Positive, Spec


class BulletSpec(Spec):
    """Level ground under gravity, moved by PyBullet.

    tick s; friction: Coulomb coefficient under the wheels; arena m: half the side of the square that the
    robot may not leave; gravity m/s².
    """

    kind: Literal["bullet"] = "bullet"
    tick: Positive = Field(default=0.001, le=0.01)
    friction: NonNegative = 0.8
    arena: Positive = 20.0
    gravity: Positive = 9.81
