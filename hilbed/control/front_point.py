"""Tracking by a point ahead of the axle, with an estimated heading: Pliego-Jiménez (2023), section 5."""

from __future__ import annotations

from math import cos, sin
from typing import Literal

from hilbed.ports import Reference
from hilbed.spec import Positive, Spec
from hilbed.types import Command, Estimate, Nanos

Vector = tuple[float, float]


class FrontPointSpec(Spec):
    """ahead: δ, from the axle to the point (m); gain: k (1/s); limits m/s and rad/s. All free."""

    kind: Literal["front_point"] = "front_point"
    ahead: Positive = 0.1
    gain: Positive = 1.0
    max_speed: Positive = 1.0
    max_turn_rate: Positive = 4.0


def front_point(pose: tuple[float, float, float], ahead: float) -> Vector:
    """Returns z = p + δ R e₁ (m)."""
    x, y, yaw = pose
    return x + ahead * cos(yaw), y + ahead * sin(yaw)


def front_point_twist(wanted: Vector, heading: float, ahead: float) -> tuple[float, float]:
    """Returns (ν, ω) = diag(1, 1/δ) R̂ᵀ ż for a wanted velocity (m/s) of the front point."""
    c, s = cos(heading), sin(heading)
    return c * wanted[0] + s * wanted[1], (c * wanted[1] - s * wanted[0]) / ahead


class FrontPoint:
    """ż = ż_d − k (z − z_d): with the true heading the error decays as exp(−k t), whatever the robot's pose.

    z_d (free in the paper) is the front point of a robot on the reference, so that the axle comes to the
    reference as well. z is the measured one where a marker shows it, else that of the estimated pose.
    """

    def __init__(self, spec: FrontPointSpec, reference: Reference) -> None:
        self._spec = spec
        self._reference = reference
        self.saturated = 0

    def counts(self) -> dict[str, float]:
        """Returns in how many cycles the law asked for more than max_speed or max_turn_rate."""
        return {"saturated": self.saturated}

    def step(self, t: Nanos, estimate: Estimate) -> Command:
        """Returns v (m/s) and w (rad/s) for the period from `t`."""
        spec = self._spec
        x, y, yaw = estimate.mean.tolist()
        zx, zy = estimate.front or front_point((x, y, yaw), spec.ahead)
        pose, v, w = self._reference.at(t)
        dx, dy = front_point(pose, spec.ahead)
        c, s, aside = cos(pose.yaw), sin(pose.yaw), spec.ahead * w
        wanted = v * c - aside * s - spec.gain * (zx - dx), v * s + aside * c - spec.gain * (zy - dy)
        speed, turn_rate = front_point_twist(wanted, yaw, spec.ahead)
        command = Command(
            min(max(speed, -spec.max_speed), spec.max_speed),
            min(max(turn_rate, -spec.max_turn_rate), spec.max_turn_rate),
        )
        self.saturated += command != (speed, turn_rate)
        return command
