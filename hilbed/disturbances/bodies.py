"""What acts on the body and where its wheels meet the ground."""

from __future__ import annotations

from typing import Literal

from hilbed.disturbances.schedule import Disturbance, DisturbanceBase
from hilbed.effects import Effects, Surroundings
from hilbed.spec import Finite, NonNegative, Point, Positive
from hilbed.types import Nanos


class SlipPatch(DisturbanceBase):
    """A rectangle on the ground, from corner to corner (m, map), with another coefficient of friction."""

    kind: Literal["slip-patch"] = "slip-patch"
    corner: Point
    opposite: Point
    friction: NonNegative


class WheelRadius(DisturbanceBase):
    """A wheel whose rolling radius is `size` times the nominal one: odometry's systematic error."""

    kind: Literal["wheel-radius"] = "wheel-radius"
    drive: str
    size: Positive


class Push(DisturbanceBase):
    """A force (N, N; map) on the body's centre of mass and a torque (N m) about the vertical."""

    kind: Literal["push"] = "push"
    size: Point
    torque: Finite = 0.0
    length: Positive | None = 0.1


def slip_patch(spec: SlipPatch, _: int) -> Disturbance:
    """Returns the disturbance that changes friction under every wheel inside the rectangle."""
    (x0, x1), (y0, y1) = (sorted(pair) for pair in zip(spec.corner, spec.opposite, strict=True))

    def apply(_: Nanos, surroundings: Surroundings, effects: Effects) -> None:
        for wheel, (x, y) in enumerate(surroundings.wheels):
            if x0 <= x <= x1 and y0 <= y <= y1:
                effects.friction[wheel] = spec.friction

    return apply


def wheel_radius(spec: WheelRadius, wheel: int) -> Disturbance:
    """Returns the disturbance that scales the rolling radius of the wheel with that index."""

    def apply(_: Nanos, __: Surroundings, effects: Effects) -> None:
        effects.radius[wheel] *= spec.size

    return apply


def push(spec: Push, _: int) -> Disturbance:
    """Returns the disturbance that pushes and turns the body."""

    def apply(_: Nanos, __: Surroundings, effects: Effects) -> None:
        x, y, turn = effects.push
        effects.push = (x + spec.size[0], y + spec.size[1], turn + spec.torque)

    return apply
