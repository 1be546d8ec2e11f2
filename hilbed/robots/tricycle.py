"""The tricycle: one steered front wheel, driven there (type 1) or at the rear axle (type 2)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import atan, copysign, cos, pi, sin, tan
from typing import Annotated, Literal

from pydantic import Field

from hilbed.spec import Finite, Listed, Positive, Spec
from hilbed.types import Command

STEERING = "steering"
"""Name of the drive that holds an angle instead of a speed."""

Twist = tuple[float, float]
"""Speed of the rear axle's midpoint (m/s) and yaw rate (rad/s)."""

STANDSTILL = 1e-9  # m/s
STEEPEST = 1.55  # rad, 88.8°: at 90° a rear drive would turn infinitely fast


class TricycleSpec(Spec):
    """Nominal geometry, as the controller knows it; m, rad, SI.

    drive: front (type 1: the command's speed is the front wheel's) or rear (type 2: it is that of the rear
    axle's midpoint); differential: whether the rear wheels, a motor each, are told apart in curves, else both
    turn alike and slip; max_speed m/s, max_steering rad: the command is limited to them; max_steering_rate
    rad/s: what the drive of the steering axis is told at boot never to exceed; start: pose at t = 0, null for
    where the reference starts. d of the paper is free: 1 m.
    """

    kind: Literal["tricycle"] = "tricycle"
    drive: Literal["front", "rear"] = "rear"
    differential: bool = True
    wheelbase: Positive = 1.0
    track: Positive = 0.6
    wheel_radius: Positive = 0.1
    max_speed: Positive = 1.74
    max_steering: Annotated[float, Field(gt=0, le=STEEPEST)] = pi / 4
    max_steering_rate: Positive = 2.0
    urdf: str = "package:urdf/tricycle.urdf"
    start: Listed[tuple[Finite, Finite, Finite]] | None = None

    @property
    def drives(self) -> tuple[str, ...]:
        """Names of its drives, in the order in which everybody lists them: the steering axis comes last."""
        return ("traction", STEERING) if self.drive == "front" else ("left", "right", STEERING)


def front_drive(command: Command, d: float) -> Twist:
    """Returns v cos γ, v sin γ / d of a front wheel at speed v; Bui & Duong (2022), eq. (2.3)."""
    v, γ = command
    return v * cos(γ), v * sin(γ) / d


def rear_drive(command: Command, d: float) -> Twist:
    """Returns v, v tan γ / d; Bui & Duong (2022), eq. (2.4). |γ| counts up to STEEPEST, so it is finite."""
    v, γ = command
    return v, v * tan(clipped(γ, STEEPEST)) / d


def steering(twist: Twist, d: float) -> float:
    """Returns the angle γ = atan(w d / v) in [−π/2, π/2] that turns the axle as asked; (3.15) with atan.

    At standstill a quarter turn towards w, as if about to move ahead; 0 where nothing is asked. The sign of
    what a controller's rounding leaves of a zero says nothing.
    """
    v, w = twist
    if abs(v) < STANDSTILL:
        return copysign(pi / 2, w) if w else 0.0
    return atan(w * d / v)


def clipped(value: float, limit: float) -> float:
    """Returns the value in [−limit, limit]; NaN stays NaN."""
    return value if value != value else min(max(value, -limit), limit)


TWISTS: dict[str, Callable[[Command, float], Twist]] = {"front": front_drive, "rear": rear_drive}


class Tricycle:
    """Kinematics of Bui & Duong (2022), section 2.1; its Command is (v, steering angle)."""

    def __init__(self, spec: TricycleSpec) -> None:
        self._spec = spec
        self._front = spec.drive == "front"
        self._twist = TWISTS[spec.drive]
        self.drives = spec.drives

    def limited(self, command: Command) -> Command:
        """Returns the command within the limits of speed and steering angle."""
        return Command(
            clipped(command[0], self._spec.max_speed), clipped(command[1], self._spec.max_steering)
        )

    def twist(self, command: Command) -> Twist:
        """Returns speed (m/s) of the axle's midpoint and yaw rate (rad/s) that a command gives."""
        return self._twist(command, self._spec.wheelbase)

    def command(self, v: float, w: float) -> Command:
        """Returns the command, within the limits, for a speed (m/s) and a yaw rate (rad/s) of the axle.

        Where the steering angle is limited the axle keeps its speed and turns less; at standstill the front
        wheel turns towards w and waits.
        """
        spec = self._spec
        γ = clipped(steering((v, w), spec.wheelbase), spec.max_steering)
        return self.limited(Command(v / cos(γ) if self._front else v, γ))

    def wheel_speeds(self, command: Command) -> tuple[float, ...]:
        """Returns rad/s of each driven wheel, in the order of `drives`, and last the steering angle (rad)."""
        R = self._spec.wheel_radius
        γ = command[1]
        if self._front:
            return command[0] / R, γ
        v, w = self.twist(command)
        difference = 0.5 * self._spec.track * w if self._spec.differential else 0.0
        return (v - difference) / R, (v + difference) / R, γ

    def travel(self, turned: Sequence[float]) -> Twist:
        """Returns way (m) and turn (rad) of the axle, or v and w, for angles (rad) or rates of driven wheels.

        The last number is the angle of the steering axis (rad) meanwhile; where it moved, that of the middle,
        which is second order in the change. While it is held the way is an arc, exactly.
        """
        *wheels, angle = turned
        return self.twist(Command(self._spec.wheel_radius * sum(wheels) / len(wheels), angle))
