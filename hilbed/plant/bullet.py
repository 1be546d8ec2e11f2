"""The world: PyBullet moves a robot by the torques at its wheels."""

from __future__ import annotations

from collections.abc import Sequence
from math import acos, atan2, cos, degrees, isfinite, sin

from hilbed.angles import wrap
from hilbed.cost import Cost, perf_counter
from hilbed.effects import Effects
from hilbed.plant.bullet_setup import add_spin_inertia, connect, grip_ratios, load, p
from hilbed.plant.bullet_spec import BulletSpec
from hilbed.plant.urdf import Behind, Body
from hilbed.types import Diverged, Pose, ScenarioError

# Cosine of 25°: no robot on wheels comes back from there.
UPRIGHT = 0.906
# rad/s and m/s; beyond it a motor's numbers mean nothing. A NaN is not below it either.
FASTEST = 1e5
NO_PUSH = (0.0, 0.0, 0.0)


class BulletWorld:
    """Steps one robot on two wheels; lists are in the order of its drives, left then right.

    After a step: `angles` (rad), `speeds` (rad/s) of the wheels as their encoders turn, forward positive;
    `slips` (m/s), surface speed of the wheel less ground speed at the contact, forward positive. `pose` and
    `height` are worked out when somebody asks.

    `targets` (rad/s) may be set: what a wheel is pulled to by the torque that is dry friction otherwise.

    A wheel's radius factor f makes it roll as one of radius f R, and may change at any time. Bullet keeps its
    sphere of radius R; between it and the drive stands a lossless gear, ω = ω_bullet / f and
    τ_bullet = τ / f, so that power is the same on both sides. (The rotor's reflected inertia is not rescaled:
    an error of f² − 1 in it.)
    """

    def __init__(self, body: Body, spec: BulletSpec, start: Pose, inertia: Behind, cost: Cost) -> None:
        """Raises ScenarioError where PyBullet does not take the body."""
        self._spec = spec
        self._cost = cost
        self._half_track = 0.5 * body.track
        self._radius = body.radius
        ratios = grip_ratios(spec, body, inertia)
        self._client = connect(spec)
        # Where contacts carry the weight from the first tick on, rather than after a fall of one tick.
        sunk = -spec.gravity * spec.tick**2
        heading = p.getQuaternionFromEuler([0.0, 0.0, start.yaw])
        self._robot, joints = load(self._client, body, ([start.x, start.y, sunk], heading))
        add_spin_inertia(self._client, self._robot, body, joints, inertia)
        self._joints = [joints[name] for name in body.joints]
        self._treads = [joints[name] for name in body.treads]
        for wheel, ratio in zip(self._treads, ratios, strict=True):
            p.changeDynamics(
                self._robot, wheel, anisotropicFriction=[1.0, ratio, 1.0], physicsClientId=self._client
            )
        self._centre = self._centre_of_mass()
        self._friction = [0.0] * len(self._treads)
        self._factors: list[float] = []
        self._coulomb: list[float] = []
        self._targets: list[float] = []
        self._set_friction([spec.friction] * len(self._treads))
        self._ticks = 0
        self._tick = spec.tick
        self._turned = [0.0] * len(self._joints)
        self.angles = [0.0] * len(self._joints)
        self.speeds = [0.0] * len(self._joints)
        self.targets = [0.0] * len(self._joints)
        self.slips = [0.0] * len(self._joints)
        self._yaw: float = start.yaw
        self._locate()

    def _centre_of_mass(self) -> tuple[float, float, float]:
        """Returns base_link's centre of mass in its frame; PyBullet's base pose is that of this point."""
        info = p.getDynamicsInfo(self._robot, -1, physicsClientId=self._client)
        (x, y, z), turn = info[3], info[4]
        if abs(turn[3]) < 1.0 - 1e-6:
            raise ScenarioError(
                "base_link: its inertia must be about axes parallel to its frame (ixy = ixz = iyz = 0)"
            )
        return x, y, z

    def turn(self, drive: int, angle: float) -> None:
        """Has a drive's joint stand at an angle (rad) from the beginning."""
        p.resetJointState(self._robot, self._joints[drive], angle, physicsClientId=self._client)
        self.angles[drive] = self._turned[drive] = angle

    def begin(self) -> None:
        """It is t = 0 now: what has been before does not count."""
        self._ticks = 0

    def step(self, torques: Sequence[float], coulomb: Sequence[float], effects: Effects) -> None:
        """Moves the world by one tick; raises Diverged.

        torques: N m at the wheels, as the drives give them; coulomb: N m of dry friction, which stops at
        zero speed, or at what `targets` say; effects: load torques, friction, radius factors and push.
        """
        factors = effects.radius
        if effects.friction != self._friction:
            self._set_friction(effects.friction)
        if factors != self._factors or coulomb != self._coulomb or self.targets != self._targets:
            self._factors, self._coulomb, self._targets = list(factors), list(coulomb), list(self.targets)
            self._set_drag()
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
        p.stepSimulation(self._client)
        self._cost.physics += perf_counter() - begun
        self._ticks += 1
        self._read(factors)

    def _set_friction(self, friction: Sequence[float]) -> None:
        for wheel, old, new in zip(self._treads, self._friction, friction, strict=True):
            if new != old:
                p.changeDynamics(self._robot, wheel, lateralFriction=new, physicsClientId=self._client)
        self._friction = list(friction)

    def _set_drag(self) -> None:
        """A motor that holds its target (zero: friction) by no more than a torque: exact, it stays set."""
        factors = self._factors
        p.setJointMotorControlArray(
            self._robot,
            self._joints,
            p.VELOCITY_CONTROL,
            targetVelocities=[speed * factor for speed, factor in zip(self._targets, factors, strict=True)],
            forces=[torque / factor for torque, factor in zip(self._coulomb, factors, strict=True)],
            physicsClientId=self._client,
        )

    def _push(self, x: float, y: float, torque: float) -> None:
        centre, _ = p.getBasePositionAndOrientation(self._robot, physicsClientId=self._client)
        p.applyExternalForce(
            self._robot, -1, [x, y, 0.0], centre, p.WORLD_FRAME, physicsClientId=self._client
        )
        p.applyExternalTorque(
            self._robot, -1, [0.0, 0.0, torque], p.WORLD_FRAME, physicsClientId=self._client
        )

    def _read(self, factors: Sequence[float]) -> None:
        """Reads wheels and velocity back; where the body is, is worked out only when somebody asks.

        Bullet turns the body by its new rate over the tick, so yaw follows from the last known one without
        error, as long as the robot stands level.
        """
        (vx, vy, _), (_, _, turning) = p.getBaseVelocity(self._robot, self._client)
        states = p.getJointStates(self._robot, self._joints, self._client)
        self._known = False
        self._yaw = yaw = self._yaw + turning * self._tick
        # Forward speed of the axle's midpoint, and half the difference between its wheels.
        speed = vx * cos(yaw) + vy * sin(yaw) + turning * self._centre[1]
        swing = turning * self._half_track
        (left, left_speed, _, _), (right, right_speed, _, _) = states
        left_factor, right_factor = factors
        turned, angles, speeds, slips = self._turned, self.angles, self.speeds, self.slips
        angles[0] += (left - turned[0]) / left_factor
        angles[1] += (right - turned[1]) / right_factor
        turned[0], turned[1] = left, right
        speeds[0], speeds[1] = left_speed / left_factor, right_speed / right_factor
        slips[0] = left_speed * self._radius - speed + swing
        slips[1] = right_speed * self._radius - speed - swing

        if not -FASTEST < left_speed + right_speed + speed < FASTEST:
            t = f"t = {self._ticks * self._tick:.3f} s"
            raise Diverged(
                f"{t}: speeds run away (wheels {left_speed}, {right_speed} rad/s, body {speed} m/s)"
            )

    @property
    def height(self) -> float:
        """Of base_link over the ground, m."""
        if not self._known:
            self._locate()
        return float(self._height)

    @property
    def pose(self) -> Pose:
        """Of the axle's midpoint; raises Diverged where the robot cannot go on from there."""
        if not self._known:
            self._locate()
        return self._pose

    def _locate(self) -> None:
        """Finds base_link's origin from its centre of mass, by the whole quaternion."""
        (x, y, z), (qx, qy, qz, qw) = p.getBasePositionAndOrientation(
            self._robot, physicsClientId=self._client
        )
        cx, cy, cz = self._centre
        forward_x = 1.0 - 2.0 * (qy * qy + qz * qz)
        forward_y = 2.0 * (qx * qy + qw * qz)
        self._upright = upright = 1.0 - 2.0 * (qx * qx + qy * qy)
        x -= forward_x * cx + 2.0 * (qx * qy - qw * qz) * cy + 2.0 * (qx * qz + qw * qy) * cz
        y -= forward_y * cx + (1.0 - 2.0 * (qx * qx + qz * qz)) * cy + 2.0 * (qy * qz - qw * qx) * cz
        self._height = z - (2.0 * (qx * qz - qw * qy) * cx + 2.0 * (qy * qz + qw * qx) * cy + upright * cz)
        self._yaw = yaw = wrap(atan2(forward_y, forward_x))
        self._pose = Pose(x, y, yaw)
        self._known = True
        bound = self._spec.arena
        # Written so that a NaN fails it.
        if not (upright > UPRIGHT and -bound < x < bound and -bound < y < bound):
            self._diverge()

    def _diverge(self) -> None:
        t = f"t = {self._ticks * self._spec.tick:.3f} s"
        x, y, yaw = self._pose
        if not isfinite(x + y + yaw + self._upright):
            raise Diverged(f"{t}: the robot's pose is not finite (x = {x}, y = {y}, yaw = {yaw})")
        where = f"at x = {x:.2f}, y = {y:.2f} m"
        if self._upright <= UPRIGHT:
            raise Diverged(f"{t}: the robot fell over {where} (tilt {degrees(acos(self._upright)):.0f}°)")
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
            for wheel in self._treads
        ]

    def close(self) -> None:
        """Gives the client back."""
        p.disconnect(self._client)
