"""How exact the plant is, against closed forms: the numbers that its tests hold and a script prints."""

from __future__ import annotations

from math import hypot
from typing import NamedTuple

from hilbed.cost import Cost
from hilbed.effects import Effects
from hilbed.plant.bullet import BulletWorld
from hilbed.plant.bullet_spec import BulletSpec
from hilbed.plant.chopper import Averaged
from hilbed.plant.drivetrain import DriveTrain, reflected_inertia
from hilbed.plant.gear import GEARS, GearSpec
from hilbed.plant.motor import MOTORS
from hilbed.plant.urdf import Behind, diffdrive
from hilbed.resources import package_file
from hilbed.types import Pose

MOTOR = MOTORS["re35"]
GEAR = GEARS["gp32c-33"]
RADIUS, TRACK = 0.1, 0.4
# Of urdf/diffdrive.urdf: all of it (kg), a wheel's spin, all about the vertical through the axle (kg m²).
MASS, WHEEL_SPIN = 9.0, 0.0025
TURNING = 0.1749 + 8.0 * 0.06**2 + 2 * (0.001317 + 0.5 * 0.2**2)
# Centre of mass behind the axle and over the ground (m), and what each wheel carries at rest (N).
BEHIND = 8.0 * 0.06 / MASS
HEIGHT = (8.0 * 0.08 + 2 * 0.5 * RADIUS) / MASS
CARRIED = 9.81 * MASS * (1.0 - BEHIND / 0.2) / 2
SPIN = WHEEL_SPIN + reflected_inertia(MOTOR, GEAR)
# What a wheel has to move going straight on.
SHARE = SPIN + MASS * RADIUS**2 / 2
DT = 0.001
VOLTS = 24.0
NONE = (0.0, 0.0)


def world(spec: BulletSpec | None = None, start: Pose | None = None) -> BulletWorld:
    """Returns the robot of the bench on its drives' inertia."""
    body = diffdrive(package_file("urdf/diffdrive.urdf"), RADIUS, TRACK)
    pose = start or Pose(0.0, 0.0, 0.0)
    return BulletWorld(body, spec or BulletSpec(), pose, Behind(SPIN - WHEEL_SPIN), Cost())


class Rolling(NamedTuple):
    """Relative errors of distance and yaw against wheel rotation."""

    distance: float
    yaw: float


def rolling(seconds: float = 10.0) -> Rolling:
    """Drives a circle without slip, at 0.5 m/s, and compares the way with what the wheels have turned."""
    robot, effects = world(), Effects([0.8, 0.8])
    distance = turned = 0.0
    last = robot.pose
    for _ in range(round(seconds / DT)):
        torques = [0.4 * (ref - speed) for ref, speed in zip((4.5, 5.5), robot.speeds, strict=True)]
        robot.step(torques, NONE, effects)
        pose = robot.pose
        distance += hypot(pose.x - last.x, pose.y - last.y)
        turned += (pose.yaw - last.yaw + 3.0) % 6.283185307179586 - 3.0
        last = pose
    left, right = robot.angles
    robot.close()
    return Rolling(
        distance / (RADIUS * (left + right) / 2) - 1.0, turned / (RADIUS * (right - left) / TRACK) - 1.0
    )


def slip_onset(friction: float = 0.3, yaw: float = 0.7) -> float:
    """Raises both torques until the wheels slip; returns the relative error of that torque.

    Coulomb: τ = μ N R (M/2 + J/R²) / (M/2) for a robot of mass M that two wheels of spin inertia J push, N
    as the ground carries it at that moment.
    """
    robot = world(BulletSpec(friction=friction), Pose(0.0, 0.0, yaw))
    effects = Effects([friction, friction])
    share = 1.0 + 2.0 * SPIN / (MASS * RADIUS**2)
    # Below onset: accelerating takes load off the wheels, by height over length of the base.
    torque = 0.9 * friction * CARRIED / (1.0 + friction * HEIGHT / 0.2) * RADIUS * share
    while max(robot.slips) < 2e-4:
        torque += 0.5 * DT
        robot.step([torque, torque], NONE, effects)
    onset = friction * sum(robot.normal_forces()) / 2 * RADIUS * share
    robot.close()
    return torque / onset - 1.0


def motor_step(inertia: float = SHARE, seconds: float = 0.3) -> tuple[float, float]:
    """Steps the duty to 0.5 into an inertia (kg m² at the wheel) without dry friction or gear losses.

    Returns the largest errors of speed and current at the ticks, relative to their largest values, against
    the matrix exponential of the two-state motor.
    """
    import numpy as np
    from scipy.linalg import expm

    gear = GearSpec(ratio=GEAR.ratio)
    chopper = Averaged(resistance=0.0, current_limit=1000.0)
    duty, n = 0.5, gear.ratio
    electrical = np.array([-MOTOR.resistance, -n * MOTOR.back_emf, 1.0]) / MOTOR.inductance
    mechanical = np.array([n * MOTOR.torque_constant, -n * n * MOTOR.viscous, 0.0]) / inertia
    step = expm(np.array([electrical, mechanical, np.zeros(3)]) * DT)
    exact = np.array([0.0, 0.0, duty * VOLTS])
    train, speed, rows = DriveTrain(MOTOR, gear, chopper, DT, inertia), 0.0, []
    for _ in range(round(seconds / DT)):
        speed += train.step(duty, True, VOLTS, speed) * DT / inertia
        exact = step @ exact
        rows.append((train.current, speed, exact[0], exact[1]))
    current, omega, exact_current, exact_omega = np.array(rows).T
    return (
        float(abs(omega - exact_omega).max() / exact_omega.max()),
        float(abs(current - exact_current).max() / exact_current.max()),
    )


class Ledger(NamedTuple):
    """Where the supply's energy went (J)."""

    supply: float
    heat: float
    magnetic: float
    viscous: float
    gear: float
    coulomb: float
    load: float
    kinetic: float

    @property
    def error(self) -> float:
        """What is missing, relative to what was turned over."""
        return (self.supply - sum(self[1:])) / sum(abs(part) for part in self[1:])


# Left and right duty and when (s) they are reached, in straight lines: a bend, a straight, braking hard.
COURSE = ((0.0, 0.0, 0.0), (0.3, 0.4, 0.8), (0.4, 0.4, 1.5), (0.1, 0.1, 1.8))


def energy(course: tuple[tuple[float, float, float], ...] = COURSE, load: float = 0.5) -> Ledger:
    """Drives the robot along duties against a load torque (N m at each wheel) and keeps the books.

    Supply, heat and magnetic energy are the drives' own; gear, friction, load and kinetic energy are taken
    from the angles that the wheels turned and from the robot's motion. Nothing may slip.
    """
    import numpy as np

    robot, effects = world(), Effects([0.8, 0.8])
    effects.load_torque[:] = [load, load]
    trains = [DriveTrain(MOTOR, GEAR, Averaged(), DT, SHARE) for _ in range(2)]
    coulomb = [train.coulomb for train in trains]
    books = np.zeros(6)
    left, right, when = zip(*course, strict=True)
    t = np.arange(0.0, when[-1], DT)
    for duties in zip(np.interp(t, when, left).tolist(), np.interp(t, when, right).tolist(), strict=True):
        before = list(robot.angles)
        drives = list(zip(trains, duties, robot.speeds, strict=True))
        torques = [train.step(duty, True, VOLTS, speed) for train, duty, speed in drives]
        robot.step(torques, coulomb, effects)
        for train, old, new in zip(trains, before, robot.angles, strict=True):
            books += _entries(train, new - old, load)
    supply, heat, viscous, gear, dry, lifted = books.tolist()
    magnetic = sum(MOTOR.inductance * train.current**2 / 2 for train in trains)
    motion = kinetic(robot)
    robot.close()
    return Ledger(supply, heat, magnetic, viscous, gear, dry, lifted, motion)


def _entries(train: DriveTrain, turn: float, load: float) -> tuple[float, ...]:
    """Returns supply, heat, viscous, gear, dry and load energy (J) of a wheel's tick, by its turn (rad)."""
    drag = MOTOR.viscous * GEAR.ratio * turn / DT
    power = GEAR.ratio * (MOTOR.torque_constant * train.mean_current - drag) * turn
    passed = GEAR.efficiency if power > 0.0 else 1.0 / GEAR.back_efficiency
    return (
        VOLTS * train.supply_current * DT,
        train.heat,
        drag * GEAR.ratio * turn,
        power * (1.0 - passed),
        train.coulomb * abs(turn),
        load * turn,
    )


def kinetic(robot: BulletWorld) -> float:
    """Returns the energy of motion (J) of the robot while it rolls, from the speeds of its wheels."""
    left, right = robot.speeds
    speed, turning = RADIUS * (left + right) / 2, RADIUS * (right - left) / TRACK
    return 0.5 * (MASS * speed * speed + TURNING * turning * turning + SPIN * (left * left + right * right))
