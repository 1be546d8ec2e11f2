"""The world: PyBullet moves a two-wheel robot by the torques at its wheels."""

from __future__ import annotations

from collections.abc import Sequence
from math import acos, atan2, cos, degrees, isfinite, sin

from hilbed.angles import wrap
from hilbed.cost import Cost, perf_counter
from hilbed.effects import Effects
from hilbed.plant.bullet_setup import add_spin_inertia, connect, grip_ratios, load, p
from hilbed.plant.bullet_spec import BulletSpec
from hilbed.plant.urdf import Body
from hilbed.types import Diverged, Pose, ScenarioError

# Cosine of 25°: no robot on wheels comes back from there.
UPRIGHT = 0.906
NO_PUSH = (0.0, 0.0, 0.0)


class BulletWorld:
    """Steps one robot; lists are in the order of its drives, left then right.

    After a step: `angles` (rad), `speeds` (rad/s) of the wheels as their encoders turn, forward positive;
    `slips` (m/s), surface speed of the wheel less ground speed at the contact, forward positive; `pose`, of
    the axle's midpoint; `height` (m) of base_link over the ground; `upright`, cosine of the tilt.

    A wheel's radius factor f makes it roll as one of radius f R, and may change at any time. Bullet keeps its
    sphere of radius R; between it and the drive stands a lossless gear, ω = ω_bullet / f and
    τ_bullet = τ / f, so that power is the same on both sides. (The rotor's reflected inertia is not rescaled:
    an error of f² − 1 in it.)
    """

    def __init__(self, body: Body, spec: BulletSpec, start: Pose, inertia: float, cost: Cost) -> None:
        """inertia: kg m² that turns with each wheel behind its gear. Raises ScenarioError."""
        self._spec = spec
        self._cost = cost
        self._half_track = 0.5 * body.track
        self._radius = body.radius
        ratios = grip_ratios(spec, body, inertia)
        self._client = connect(spec)
        # Where contacts carry the weight from the first tick on, rather than after a fall of one tick.
        sunk = -spec.gravity * spec.tick**2
        heading = p.getQuaternionFromEuler([0.0, 0.0, start.yaw])
        self._robot, self._joints = load(self._client, body, ([start.x, start.y, sunk], heading))
        add_spin_inertia(self._client, self._robot, self._joints, inertia)
        for wheel, ratio in zip(self._joints, ratios, strict=True):
            p.changeDynamics(
                self._robot, wheel, anisotropicFriction=[1.0, ratio, 1.0], physicsClientId=self._client
            )
        self._centre = self._centre_of_mass()
        self._friction = [0.0] * len(self._joints)
        self._drag = [0.0] * len(self._joints)
        self._set_friction([spec.friction] * len(self._joints))
        self._ticks = 0
        self._turned = [0.0] * len(self._joints)
        self.angles = [0.0] * len(self._joints)
        self.speeds: list[float] = []
        self.slips: list[float] = []
        self._refresh([1.0] * len(self._joints))

    def _centre_of_mass(self) -> tuple[float, float, float]:
        """Returns base_link's centre of mass in its frame; PyBullet's base pose is that of this point."""
        info = p.getDynamicsInfo(self._robot, -1, physicsClientId=self._client)
        (x, y, z), turn = info[3], info[4]
        if abs(turn[3]) < 1.0 - 1e-6:
            raise ScenarioError(
                "base_link: its inertia must be about axes parallel to its frame (ixy = ixz = iyz = 0)"
            )
        return x, y, z

    def step(self, torques: Sequence[float], coulomb: Sequence[float], effects: Effects) -> None:
        """Moves the world by one tick; raises Diverged.

        torques: N m at the wheels, as the drives give them; coulomb: N m of dry friction, which stops at
        zero speed; effects: load torques, friction, radius factors and push.
        """
        factors = effects.radius
        if effects.friction != self._friction:
            self._set_friction(effects.friction)
        drag = [friction / factor for friction, factor in zip(coulomb, factors, strict=True)]
        if drag != self._drag:
            self._set_drag(drag)
        if effects.push != NO_PUSH:
            self._push(*effects.push)
        p.setJointMotorControlArray(
            self._robot,
            self._joints,
            p.TORQUE_CONTROL,
            forces=[
                (torque - load) / factor
                for torque, load, factor in zip(torques, effects.load_torque, factors, strict=True)
            ],
            physicsClientId=self._client,
        )
        begun = perf_counter()
        p.stepSimulation(physicsClientId=self._client)
        self._cost.physics += perf_counter() - begun
        self._ticks += 1
        self._refresh(factors)

    def _set_friction(self, friction: Sequence[float]) -> None:
        for wheel, old, new in zip(self._joints, self._friction, friction, strict=True):
            if new != old:
                p.changeDynamics(self._robot, wheel, lateralFriction=new, physicsClientId=self._client)
        self._friction = list(friction)

    def _set_drag(self, drag: list[float]) -> None:
        """A motor that holds zero speed with no more than the dry friction: exact, and it stays set."""
        p.setJointMotorControlArray(
            self._robot, self._joints, p.VELOCITY_CONTROL, forces=drag, physicsClientId=self._client
        )
        self._drag = drag

    def _push(self, x: float, y: float, torque: float) -> None:
        centre, _ = p.getBasePositionAndOrientation(self._robot, physicsClientId=self._client)
        p.applyExternalForce(
            self._robot, -1, [x, y, 0.0], centre, p.WORLD_FRAME, physicsClientId=self._client
        )
        p.applyExternalTorque(
            self._robot, -1, [0.0, 0.0, torque], p.WORLD_FRAME, physicsClientId=self._client
        )

    def _refresh(self, factors: Sequence[float]) -> None:
        """Reads the state back: base_link's origin from its centre of mass, by the whole quaternion."""
        (x, y, z), (qx, qy, qz, qw) = p.getBasePositionAndOrientation(
            self._robot, physicsClientId=self._client
        )
        (vx, vy, _), (_, _, turning) = p.getBaseVelocity(self._robot, physicsClientId=self._client)
        states = p.getJointStates(self._robot, self._joints, physicsClientId=self._client)
        cx, cy, cz = self._centre
        forward_x = 1.0 - 2.0 * (qy * qy + qz * qz)
        forward_y = 2.0 * (qx * qy + qw * qz)
        self.upright = upright = 1.0 - 2.0 * (qx * qx + qy * qy)
        x -= forward_x * cx + 2.0 * (qx * qy - qw * qz) * cy + 2.0 * (qx * qz + qw * qy) * cz
        y -= forward_y * cx + (1.0 - 2.0 * (qx * qx + qz * qz)) * cy + 2.0 * (qy * qz - qw * qx) * cz
        self.height = z - (2.0 * (qx * qz - qw * qy) * cx + 2.0 * (qy * qz + qw * qx) * cy + upright * cz)
        self.pose = Pose(x, y, wrap(atan2(forward_y, forward_x)))
        # Forward speed of the axle's midpoint, and half the difference between its wheels.
        speed = vx * forward_x + vy * forward_y + turning * cy
        swing = turning * self._half_track
        (left, left_speed, _, _), (right, right_speed, _, _) = states
        left_factor, right_factor = factors
        turned, self._turned = self._turned, [left, right]
        angles = self.angles
        angles[0] += (left - turned[0]) / left_factor
        angles[1] += (right - turned[1]) / right_factor
        self.speeds = [left_speed / left_factor, right_speed / right_factor]
        self.slips = [left_speed * self._radius - speed + swing, right_speed * self._radius - speed - swing]
        bound = self._spec.arena
        # Written so that a NaN fails it.
        if not (upright > UPRIGHT and -bound < x < bound and -bound < y < bound):
            self._diverge()

    def _diverge(self) -> None:
        t = f"t = {self._ticks * self._spec.tick:.3f} s"
        x, y, yaw = self.pose
        if not isfinite(x + y + yaw + self.upright):
            raise Diverged(f"{t}: the robot's pose is not finite (x = {x}, y = {y}, yaw = {yaw})")
        where = f"at x = {x:.2f}, y = {y:.2f} m"
        if self.upright <= UPRIGHT:
            raise Diverged(f"{t}: the robot fell over {where} (tilt {degrees(acos(self.upright)):.0f}°)")
        raise Diverged(f"{t}: the robot left the arena of ±{self._spec.arena:g} m {where}")

    @property
    def wheels(self) -> list[tuple[float, float]]:
        """Where each wheel touches the ground (m, map)."""
        x, y, yaw = self.pose
        across_x, across_y = -sin(yaw) * self._half_track, cos(yaw) * self._half_track
        return [(x + across_x, y + across_y), (x - across_x, y - across_y)]

    def normal_forces(self) -> list[float]:
        """Returns the force (N) with which the ground carries each wheel."""
        return [
            sum(
                contact[9]
                for contact in p.getContactPoints(self._robot, linkIndexA=wheel, physicsClientId=self._client)
            )
            for wheel in self._joints
        ]

    def close(self) -> None:
        """Gives the client back."""
        p.disconnect(self._client)
