"""The world of a robot on three wheels, the front one steered."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, sin

from hilbed.cost import Cost
from hilbed.plant.bullet import FASTEST, BulletWorld
from hilbed.plant.bullet_setup import p
from hilbed.plant.bullet_spec import BulletSpec
from hilbed.plant.urdf import Behind, Body
from hilbed.types import Diverged, Pose


class TricycleWorld(BulletWorld):
    """Steps a tricycle: front wheel then steering axis, or left, right, then steering axis, by its drives.

    `slips` of the steering axis is zero; its angle and speed are about the vertical. Wheels without a drive
    touch the ground with the same friction, after those that have one in `wheels` and `normal_forces`.
    """

    def __init__(self, body: Body, spec: BulletSpec, start: Pose, inertia: Behind, cost: Cost) -> None:
        self._wheelbase = body.wheelbase
        self._front = len(body.driven) == 1
        super().__init__(body, spec, start, inertia, cost)

    def _read(self, factors: Sequence[float]) -> None:
        """Reads drives and velocity back; see there."""
        (vx, vy, _), (_, _, turning) = p.getBaseVelocity(self._robot, self._client)
        states = p.getJointStates(self._robot, self._joints, self._client)
        self._known = False
        self._yaw = yaw = self._yaw + turning * self._tick
        cx, cy, _ = self._centre
        ahead, aside = cos(yaw), sin(yaw)
        # Of the rear axle's midpoint, along and across.
        speed = vx * ahead + vy * aside + turning * cy
        drift = vy * ahead - vx * aside - turning * cx
        turned = self._turned
        for k, ((angle, rate, _, _), factor) in enumerate(zip(states, factors, strict=True)):
            self.angles[k] += (angle - turned[k]) / factor
            turned[k] = angle
            self.speeds[k] = rate / factor
        radius, slips = self._radius, self.slips
        if self._front:
            γ = turned[1]
            slips[0] = states[0][1] * radius - speed * cos(γ) - (drift + turning * self._wheelbase) * sin(γ)
        else:
            swing = turning * self._half_track
            slips[0] = states[0][1] * radius - speed + swing
            slips[1] = states[1][1] * radius - speed - swing
        if not -FASTEST < sum(self.speeds) + speed < FASTEST:
            t = f"t = {self._ticks * self._tick:.3f} s"
            raise Diverged(f"{t}: speeds run away (drives {self.speeds} rad/s, body {speed} m/s)")

    @property
    def wheels(self) -> list[tuple[float, float]]:
        """Where each wheel touches the ground (m, map)."""
        x, y, yaw = self.pose
        d = self._wheelbase
        front, rear = [(x + d * cos(yaw), y + d * sin(yaw))], super().wheels
        return front + rear if self._front else rear + front
