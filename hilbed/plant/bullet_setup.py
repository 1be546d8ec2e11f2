"""A PyBullet client set up so that wheels roll, slip and coast as they should; reasons beside each value."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from math import sqrt
from pathlib import Path

from hilbed.plant.bullet_spec import BulletSpec
from hilbed.plant.urdf import Behind, Body
from hilbed.quiet import muted
from hilbed.types import ScenarioError

with muted():
    import pybullet as p

__all__ = ["add_spin_inertia", "connect", "grip_ratios", "load", "p"]


def connect(spec: BulletSpec) -> int:
    """Opens a client of its own with level ground; returns its number."""
    client: int = p.connect(p.DIRECT)
    p.setTimeStep(spec.tick, physicsClientId=client)
    p.setGravity(0.0, 0.0, -spec.gravity, physicsClientId=client)
    p.setPhysicsEngineParameter(
        numSolverIterations=50,
        solverResidualThreshold=1e-12,
        # A global of the process that outlives the client: unset, a run depends on the one before.
        contactBreakingThreshold=0.02,
        enableConeFriction=1,
        # Otherwise a URDF of the same name would come from the cache.
        enableFileCaching=0,
        physicsClientId=client,
    )
    plane = p.createCollisionShape(p.GEOM_PLANE, physicsClientId=client)
    ground = p.createMultiBody(0.0, plane, physicsClientId=client)
    # Coefficients of a pair multiply, so that with 1 here the wheel's own value is the coefficient.
    p.changeDynamics(ground, -1, lateralFriction=1.0, **_NO_LOSSES, physicsClientId=client)
    return client


_NO_LOSSES = {"rollingFriction": 0.0, "spinningFriction": 0.0, "restitution": 0.0}
_NO_DAMPING = {"linearDamping": 0.0, "angularDamping": 0.0, "jointDamping": 0.0}


def load(client: int, body: Body, at: tuple[Sequence[float], Sequence[float]]) -> tuple[int, dict[str, int]]:
    """Loads a robot with base_link at a position and quaternion; returns its number and its joints' links."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "robot.urdf"
        file.write_text(body.text)
        try:
            with muted():
                robot: int = p.loadURDF(
                    str(file), *at, flags=p.URDF_USE_INERTIA_FROM_FILE, physicsClientId=client
                )
        except p.error as error:
            raise ScenarioError(f"PyBullet does not load the robot's URDF: {error}") from None
    joints = range(p.getNumJoints(robot, physicsClientId=client))
    by_name = {p.getJointInfo(robot, joint, physicsClientId=client)[1].decode(): joint for joint in joints}
    for link in (-1, *joints):
        p.changeDynamics(
            robot, link, lateralFriction=0.0, **_NO_LOSSES, **_NO_DAMPING, physicsClientId=client
        )
    # Clamps every joint at 100 rad/s otherwise.
    p.changeDynamics(robot, -1, maxJointVelocity=1000.0, physicsClientId=client)
    # PyBullet holds every joint with 1000 N m until told otherwise.
    p.setJointMotorControlArray(
        robot, list(joints), p.VELOCITY_CONTROL, forces=[0.0] * len(joints), physicsClientId=client
    )
    return robot, by_name


def add_spin_inertia(client: int, robot: int, body: Body, joints: Mapping[str, int], inertia: Behind) -> None:
    """Adds what turns with each drive behind its gear: about a wheel's axle, a steering axis's z."""
    for name in body.joints:
        x, y, z = p.getDynamicsInfo(robot, joints[name], physicsClientId=client)[2]
        diagonal = [x, y + inertia.wheel, z] if name in body.driven else [x, y, z + inertia.steering]
        p.changeDynamics(robot, joints[name], localInertiaDiagonal=diagonal, physicsClientId=client)


def grip_ratios(spec: BulletSpec, body: Body, inertia: Behind) -> list[float]:
    """Returns the factor by which each wheel's sideways friction is scaled, found in a scratch client.

    Bullet solves friction along and across a wheel one after the other. Where the contact is much easier to
    move one way than the other, what it finds on a sliding wheel points up to 47° off (bullet3 #2590, #2851).
    Scaling the axle's direction by s = sqrt(D_along / D_across) makes both equally mobile; D is the
    speed that an impulse gives to the contact point of the free robot.
    """
    client = connect(spec)
    try:
        p.setGravity(0.0, 0.0, 0.0, physicsClientId=client)
        ratios = []
        for tread in body.treads:
            along, across = (
                _mobility(client, body, inertia, tread, force) for force in ((1.0, 0.0), (0.0, 1.0))
            )
            ratios.append(sqrt(along / across))
        return ratios
    finally:
        p.disconnect(client)


def _mobility(client: int, body: Body, inertia: Behind, tread: str, force: tuple[float, float]) -> float:
    """Returns the speed of a free robot's contact point along 1 N there for one step."""
    robot, joints = load(client, body, ([0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0]))
    add_spin_inertia(client, robot, body, joints, inertia)
    wheel = joints[tread]
    x, y, z = p.getLinkState(robot, wheel, physicsClientId=client)[0]
    p.applyExternalForce(
        robot, wheel, [*force, 0.0], [x, y, z - body.radius], p.WORLD_FRAME, physicsClientId=client
    )
    p.stepSimulation(physicsClientId=client)
    state = p.getLinkState(robot, wheel, computeLinkVelocity=1, physicsClientId=client)
    (vx, vy, _), (wx, wy, _) = state[6], state[7]
    p.removeBody(robot, physicsClientId=client)
    moved: float = force[0] * (vx - wy * body.radius) + force[1] * (vy + wx * body.radius)
    return moved
