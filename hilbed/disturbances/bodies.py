"""What acts on the body and where its wheels meet the ground."""

from __future__ import annotations

from typing import Literal

import numpy as np

from hilbed.disturbances.schedule import Disturbance, DisturbanceBase, drawn
from hilbed.effects import Effects, Surroundings
from hilbed.spec import Finite, NonNegative, Point, Positive
from hilbed.types import Nanos

SMALLEST_WHEEL = 0.1
"""Factor below which a drawn wheel radius is not taken: a wheel stays a wheel."""


class SlipPatch(DisturbanceBase):
    """A rectangle on the ground, from corner to corner (m, map), with another coefficient of friction."""

    kind: Literal["slip_patch"] = "slip_patch"
    corner: Point
    opposite: Point
    friction: NonNegative


class WheelRadius(DisturbanceBase):
    """A wheel that rolls as one of `size` ± `spread` times its radius: odometry's systematic error."""

    kind: Literal["wheel_radius"] = "wheel_radius"
    drive: str
    size: Positive
    spread: NonNegative = 0.0


class Push(DisturbanceBase):
    """A force (N, N; map) on the body's centre of mass and a torque (N m) about the vertical."""

    kind: Literal["push"] = "push"
    size: Point
    torque: Finite = 0.0
    length: Positive | None = 0.1


def slip_patch(spec: SlipPatch, _: int, __: np.random.Generator) -> Disturbance:
    """Returns the disturbance that changes friction under every wheel inside the rectangle."""
    (x0, x1), (y0, y1) = (sorted(pair) for pair in zip(spec.corner, spec.opposite, strict=True))

    def apply(_: Nanos, surroundings: Surroundings, effects: Effects) -> None:
        for wheel, (x, y) in enumerate(surroundings.wheels):
            if x0 <= x <= x1 and y0 <= y <= y1:
                effects.friction[wheel] = spec.friction

    return apply


def wheel_radius(spec: WheelRadius, wheel: int, rng: np.random.Generator) -> Disturbance:
    """Returns the disturbance that scales the rolling radius of the wheel with that index."""
    size = max(drawn(spec.size, spec.spread, rng), SMALLEST_WHEEL)

    def apply(_: Nanos, __: Surroundings, effects: Effects) -> None:
        effects.radius[wheel] *= size

    return apply


def push(spec: Push, _: int, __: np.random.Generator) -> Disturbance:
    """Returns the disturbance that pushes and turns the body."""

    def apply(_: Nanos, __: Surroundings, effects: Effects) -> None:
        x, y, turn = effects.push
        effects.push = (x + spec.size[0], y + spec.size[1], turn + spec.torque)

    return apply
