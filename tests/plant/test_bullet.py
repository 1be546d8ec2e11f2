"""The world against rigid-body mechanics on paper."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import cos, hypot, sin

import pytest

from hilbed.angles import wrap
from hilbed.cost import Cost
from hilbed.effects import Effects
from hilbed.plant.bullet import BulletWorld
from hilbed.plant.bullet_spec import BulletSpec
from hilbed.plant.checks import (
    BEHIND,
    CARRIED,
    DT,
    MASS,
    RADIUS,
    SHARE,
    SPIN,
    TRACK,
    TURNING,
    WHEEL_SPIN,
    kinetic,
    world,
)
from hilbed.plant.urdf import Behind, diffdrive
from hilbed.resources import package_file
from hilbed.types import Diverged, Pose

Make = Callable[..., BulletWorld]
NONE = (0.0, 0.0)


@pytest.fixture
def make() -> Iterator[Make]:
    made: list[BulletWorld] = []

    def build(start: Pose | None = None, **spec: float) -> BulletWorld:
        made.append(world(BulletSpec.model_validate(spec), start))
        return made[-1]

    yield build
    for robot in made:
        robot.close()


def run(robot: BulletWorld, torque: float, knobs: Effects, ticks: int = 2000) -> None:
    for _ in range(ticks):
        robot.step((torque, torque), NONE, knobs)
        assert robot.pose  # whether it can go on is found when somebody looks where it is


def servo(robot: BulletWorld, speeds: tuple[float, float], ticks: int, knobs: Effects) -> tuple[float, float]:
    """Holds wheel speeds (rad/s); returns distance and turn on the way."""
    distance = turned = 0.0
    for _ in range(ticks):
        x, y, yaw = robot.pose
        torques = [0.4 * (ref - speed) for ref, speed in zip(speeds, robot.speeds, strict=True)]
        robot.step(torques, NONE, knobs)
        distance += hypot(robot.pose.x - x, robot.pose.y - y)
        turned += wrap(robot.pose.yaw - yaw)
    return distance, turned


def effects(friction: float = 0.8) -> Effects:
    return Effects([friction, friction])


def test_stands_still_where_it_is_put(make: Make) -> None:
    robot, start = make(Pose(1.0, -2.0, 2.5)), Pose(1.0, -2.0, 2.5)
    for _ in range(500):
        robot.step(NONE, NONE, effects())
    assert robot.pose == pytest.approx(start, abs=1e-8)
    assert robot.height == pytest.approx(0.0, abs=2e-5)
    assert robot.normal_forces() == pytest.approx([CARRIED] * 2, rel=1e-4)


def test_pose_is_that_of_the_axle_not_of_the_centre_of_mass(make: Make) -> None:
    """Only the axle's midpoint moves along the heading, by what the wheels have turned, while it spins."""
    robot, knobs, x, y = make(Pose(0.5, 0.5, 0.0)), effects(), 0.5, 0.5
    for _ in range(1500):
        yaw, turned = robot.pose.yaw, sum(robot.angles)
        servo(robot, (-2.0, 2.0), 1, knobs)
        way, heading = RADIUS * (sum(robot.angles) - turned) / 2, (yaw + robot.pose.yaw) / 2
        x, y = x + way * cos(heading), y + way * sin(heading)
    assert robot.pose.yaw > 1.0
    assert robot.pose[:2] == pytest.approx((x, y), abs=1e-4)
    (x_left, y_left), (x_right, y_right) = robot.wheels
    yaw = robot.pose.yaw
    assert (x_left - x_right, y_left - y_right) == pytest.approx((-TRACK * sin(yaw), TRACK * cos(yaw)))


def test_load_torque_is_taken_off(make: Make) -> None:
    robot, knobs = make(), effects()
    knobs.load_torque[:] = [0.3, 0.3]
    for _ in range(1000):
        robot.step((0.8, 0.8), NONE, knobs)
    assert robot.speeds == pytest.approx([0.5 / SHARE] * 2, rel=1e-3)


def test_coulomb_friction_stops_at_zero_and_holds(make: Make) -> None:
    robot, rest = make(), effects()
    for _ in range(500):
        robot.step((0.5, 0.5), NONE, rest)
    speed, angle = robot.speeds[0], robot.angles[0]
    for _ in range(1000):
        robot.step(NONE, (0.4, 0.4), rest)
    # v²/2a with a = τ_c / J.
    assert robot.angles[0] - angle == pytest.approx(speed**2 * SHARE / 0.8, rel=5e-3)
    assert robot.speeds == pytest.approx([0.0, 0.0], abs=1e-6)
    for _ in range(200):
        robot.step((0.39, 0.39), (0.4, 0.4), rest)
    assert robot.speeds == pytest.approx([0.0, 0.0], abs=1e-6)


def test_coasts_without_friction_for_ever(make: Make) -> None:
    robot, rest = make(), effects()
    for _ in range(1000):
        robot.step((0.4, 0.4), NONE, rest)
    speed = robot.speeds[0]
    for _ in range(3000):
        robot.step(NONE, NONE, rest)
    assert robot.speeds[0] == pytest.approx(speed, rel=1e-4)


def test_wheels_on_ice_spin_alone(make: Make) -> None:
    """Without friction under it a wheel is its spin inertia, the rotor's included, and slips as it turns."""
    robot = make(friction=0.0)
    for _ in range(100):
        robot.step((0.1, -0.1), NONE, effects(0.0))
    turning = 0.1 / SPIN * 0.1
    assert robot.speeds == pytest.approx([turning, -turning], rel=1e-3)
    assert robot.slips == pytest.approx([RADIUS * turning, -RADIUS * turning], rel=1e-3)


def test_sliding_force_is_mu_times_load(make: Make) -> None:
    robot, ice = make(friction=0.1), effects(0.1)
    for _ in range(300):
        robot.step((1.5, 1.5), NONE, ice)
    before, loads = robot.pose.x, robot.normal_forces()
    speed = [robot.speeds[0] * RADIUS - robot.slips[0]]
    for _ in range(200):
        robot.step((1.5, 1.5), NONE, ice)
    speed.append(robot.speeds[0] * RADIUS - robot.slips[0])
    assert robot.pose.x > before
    assert (speed[1] - speed[0]) / 0.2 * MASS == pytest.approx(0.1 * sum(loads), rel=0.01)


@pytest.mark.parametrize("yaw", [0.0, 0.7, 2.4])
def test_wheels_that_slip_at_any_heading_do_not_turn_the_robot(make: Make, yaw: float) -> None:
    robot = make(Pose(0.0, 0.0, yaw), friction=0.2)
    for _ in range(500):
        robot.step((2.0, 2.0), NONE, effects(0.2))
    assert min(robot.slips) > 0.5
    assert robot.pose.yaw == pytest.approx(yaw, abs=2e-3)


def test_slip_patch_under_one_wheel(make: Make) -> None:
    robot, patch = make(), effects()
    patch.friction[0] = 0.05
    for _ in range(200):
        robot.step((0.9, 0.9), NONE, patch)
    assert robot.slips[0] > 0.1
    assert abs(robot.slips[1]) < 1e-3
    assert robot.pose.yaw > 0.01
    for _ in range(200):
        robot.step((0.2, 0.2), NONE, effects())
    assert robot.slips == pytest.approx([0.0, 0.0], abs=1e-3)


def test_push_accelerates_the_body(make: Make) -> None:
    robot, knobs = make(Pose(0.0, 0.0, 0.6), friction=0.0), effects(0.0)
    knobs.push = (6.0, -4.0, 0.0)
    for _ in range(100):
        robot.step(NONE, NONE, knobs)
    knobs.reset()
    # By now the force has moved it by F t²/2m; it goes on with F t/m.
    for _ in range(400):
        robot.step(NONE, NONE, knobs)
    way = (0.1**2 / 2 + 0.1 * 0.4) / MASS
    # The push is on the body's centre, 7 mm behind that of the whole robot: it turns it a little.
    assert robot.pose[:2] == pytest.approx((6.0 * way, -4.0 * way), abs=2e-3)


def test_push_turns_the_body(make: Make) -> None:
    robot, knobs = make(Pose(0.0, 0.0, 1.1), friction=0.0), effects(0.0)
    knobs.push = (0.0, 0.0, 0.5)
    for _ in range(100):
        robot.step(NONE, NONE, knobs)
    knobs.reset()
    yaw = robot.pose.yaw
    for _ in range(100):
        robot.step(NONE, NONE, knobs)
    about_centre = TURNING - MASS * BEHIND**2
    assert (robot.pose.yaw - yaw) / 0.1 == pytest.approx(0.5 * 0.1 / about_centre, rel=0.01)


def test_radius_mismatch_bends_the_path(make: Make) -> None:
    robot, knobs = make(), effects()
    knobs.radius[:] = [1.02, 1.0]
    distance, turned = servo(robot, (5.0, 5.0), 4000, knobs)
    left, right = 1.02 * robot.angles[0], robot.angles[1]
    assert distance == pytest.approx(RADIUS * (left + right) / 2, rel=5e-4)
    assert turned == pytest.approx(RADIUS * (right - left) / TRACK, rel=5e-4)


def test_radius_mismatch_conserves_power(make: Make) -> None:
    robot, knobs = make(), effects()
    knobs.radius[:] = [1.1, 1.1]
    for _ in range(1000):
        robot.step((0.5, 0.5), NONE, knobs)
    work = 0.5 * sum(robot.angles)
    # Bullet's side of the virtual gear: the wheels' spin at the speed of a wheel of the nominal radius.
    robot.speeds = [1.1 * speed for speed in robot.speeds]
    assert kinetic(robot) == pytest.approx(work, rel=5e-3)


def test_radius_may_change_without_a_jump_of_the_encoder(make: Make) -> None:
    robot, knobs = make(), effects()
    for _ in range(1000):
        robot.step((0.3, 0.3), NONE, knobs)
    angle, speed = robot.angles[0], robot.speeds[0]
    knobs.radius[:] = [1.5, 1.5]
    robot.step((0.3, 0.3), NONE, knobs)
    assert robot.angles[0] - angle == pytest.approx(speed * DT / 1.5, rel=0.01)


def drive(robot: BulletWorld, ticks: int) -> bytes:
    trace, knobs = [], effects()
    for k in range(ticks):
        knobs.friction[0] = 0.02 if 100 < k < 200 else 0.8
        knobs.push = (0.0, 5.0, 0.1) if k > 250 else (0.0, 0.0, 0.0)
        robot.step((0.8 + 0.001 * k, 0.6), (0.1, 0.1), knobs)
        trace.append((robot.pose, tuple(robot.angles), tuple(robot.speeds), tuple(robot.slips)))
    return repr(trace).encode()


def test_the_same_to_the_bit_in_one_process(make: Make) -> None:
    assert drive(make(), 400) == drive(make(), 400)


def test_the_same_to_the_bit_between_other_clients(make: Make) -> None:
    alone = drive(make(), 300)
    one, other, knobs, trace = make(), make(Pose(3.0, 3.0, 1.0)), effects(), []
    for k in range(300):
        knobs.friction[0] = 0.02 if 100 < k < 200 else 0.8
        knobs.push = (0.0, 5.0, 0.1) if k > 250 else (0.0, 0.0, 0.0)
        one.step((0.8 + 0.001 * k, 0.6), (0.1, 0.1), knobs)
        trace.append((one.pose, tuple(one.angles), tuple(one.speeds), tuple(one.slips)))
        other.step((0.3, -0.3), NONE, effects())
    assert repr(trace).encode() == alone


def test_leaving_the_arena_is_divergence(make: Make) -> None:
    robot = make(arena=0.2)
    with pytest.raises(Diverged, match=r"t = 0\.\d+ s: the robot left the arena of ±0.2 m at x = 0.20"):
        run(robot, 1.0, effects())


def test_falling_over_is_divergence(make: Make) -> None:
    robot = make()
    with pytest.raises(Diverged, match=r"the robot fell over at x = .* \(tilt \d+°\)"):
        run(robot, -8.0, effects())


def test_a_torque_that_is_no_number_is_divergence(make: Make) -> None:
    robot = make()
    with pytest.raises(Diverged, match="run away"):
        run(robot, float("nan"), effects(), 3)


@pytest.mark.parametrize(("radius", "track"), [(0.05, 0.25), (0.15, 0.6)])
def test_another_geometry_rolls_as_well(radius: float, track: float) -> None:
    body = diffdrive(package_file("urdf/diffdrive.urdf"), radius, track)
    robot = BulletWorld(body, BulletSpec(), Pose(0.0, 0.0, 0.0), Behind(0.005), Cost())
    _, turned = servo(robot, (3.0, 4.0), 2000, effects())
    left, right = robot.angles
    robot.close()
    assert turned == pytest.approx(radius * (right - left) / track, rel=5e-4)


def test_physics_time_is_booked(make: Make) -> None:
    robot = make()
    robot.step(NONE, NONE, effects())
    assert robot._cost.physics > 0.0


def test_wheel_inertia_is_that_of_the_drive() -> None:
    assert pytest.approx(0.0025 + (79.2e-7 + 0.8e-7) * 33.0**2) == SPIN
    assert WHEEL_SPIN == 0.0025
