"""What acts on the body and where its wheels meet the ground."""

from __future__ import annotations

from math import inf
from typing import Annotated, Literal

from pydantic import Field

from hilbed.clock import nanos
from hilbed.disturbances.schedule import STEADY, Disturbance, DisturbanceBase, drawn
from hilbed.effects import Effects, Surroundings
from hilbed.spec import Finite, NonNegative, Point, Positive
from hilbed.types import Nanos, Rng

FASTEST = 10.0
"""m/s; no wheel gets to the edge of a patch sooner than at this speed."""

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
    size: Annotated[float, Field(ge=SMALLEST_WHEEL, le=10)]
    spread: NonNegative = 0.0


class Push(DisturbanceBase):
    """A force (N, N; map) on the body's centre of mass and a torque (N m) about the vertical."""

    kind: Literal["push"] = "push"
    size: Point
    torque: Finite = 0.0
    length: Positive | None = 0.1


def slip_patch(spec: SlipPatch, _: int, __: Rng) -> Disturbance:
    """Returns the disturbance that changes friction under every wheel inside the rectangle."""
    (x0, x1), (y0, y1) = (sorted(pair) for pair in zip(spec.corner, spec.opposite, strict=True))

    def apply(_: Nanos, surroundings: Surroundings, effects: Effects) -> Nanos:
        nearest = inf
        for wheel, (x, y) in enumerate(surroundings.wheels):
            right, above = max(x0 - x, x - x1), max(y0 - y, y - y1)  # negative inside
            if right <= 0 and above <= 0:
                effects.friction[wheel] = spec.friction
            nearest = min(nearest, abs(max(right, above)))
        return nanos(nearest / FASTEST)

    return apply


def wheel_radius(spec: WheelRadius, wheel: int, rng: Rng) -> Disturbance:
    """Returns the disturbance that scales the rolling radius of the wheel with that index."""
    size = max(drawn(spec.size, spec.spread, rng), SMALLEST_WHEEL)

    def apply(_: Nanos, __: Surroundings, effects: Effects) -> Nanos:
        effects.radius[wheel] *= size
        return STEADY

    return apply


def push(spec: Push, _: int, __: Rng) -> Disturbance:
    """Returns the disturbance that pushes and turns the body."""

    def apply(_: Nanos, __: Surroundings, effects: Effects) -> Nanos:
        x, y, turn = effects.push
        effects.push = (x + spec.size[0], y + spec.size[1], turn + spec.torque)
        return STEADY

    return apply
