from __future__ import annotations

from math import copysign, cos, inf, isfinite, nan, pi, sin, tan

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError
from scipy.integrate import solve_ivp

from hilbed.control.steered import Steered
from hilbed.estimation.no_covariance import NO_COVARIANCE
from hilbed.plant.kinematics import exact
from hilbed.robots.tricycle import (
    STEEPEST,
    Tricycle,
    TricycleSpec,
    front_drive,
    rear_drive,
    steering,
)
from hilbed.types import Command, Estimate, Pose

DRIVES = pytest.mark.parametrize("drive", ["front", "rear"])
speeds, angles = st.floats(-1.7, 1.7), st.floats(-pi / 4, pi / 4)
sizes = st.floats(0.2, 3.0)


def tricycle(**settings: object) -> Tricycle:
    return Tricycle(TricycleSpec.model_validate(settings))


@given(speeds, angles, sizes)
def test_both_types_roll_without_sideways_slip_at_either_axle(v: float, γ: float, d: float) -> None:
    """The front wheel's hub moves along the wheel: (v, w d) is parallel to (cos γ, sin γ)."""
    for twist in (front_drive(Command(v, γ), d), rear_drive(Command(v, γ), d)):
        assert twist[0] * sin(γ) == pytest.approx(twist[1] * d * cos(γ), abs=1e-12)
    ahead, turn = front_drive(Command(v, γ), d)
    assert ahead * cos(γ) + turn * d * sin(γ) == pytest.approx(v, abs=1e-12)  # the front wheel's own speed
    assert rear_drive(Command(v, γ), d)[0] == v


@given(speeds, angles, sizes, st.sampled_from(["front", "rear"]))
def test_a_command_that_gives_a_twist_is_found_from_it(v: float, γ: float, d: float, drive: str) -> None:
    robot = tricycle(drive=drive, wheelbase=d, max_speed=10.0)
    twist = robot.twist(Command(v, γ))
    again = robot.command(*twist)
    assert robot.twist(again) == pytest.approx(twist, abs=1e-9)
    if abs(v) > 1e-3:
        assert again == pytest.approx((v, γ), abs=1e-9)


@given(speeds, angles, st.sampled_from(["front", "rear"]), st.floats(0.01, 1.0))
def test_odometry_is_the_exact_arc(v: float, γ: float, drive: str, T: float) -> None:
    """Wheels that turned as commanded tell the way; the pose is that of the paper's equations by scipy."""
    robot, d = tricycle(drive=drive, wheelbase=0.8), 0.8
    *rates_of_wheels, angle = robot.wheel_speeds(Command(v, γ))
    distance, turn = robot.travel([*[w * T for w in rates_of_wheels], angle])
    if drive == "front":
        rates = lambda _, p: (v * cos(γ) * cos(p[2]), v * cos(γ) * sin(p[2]), v * sin(γ) / d)  # noqa: E731
    else:
        rates = lambda _, p: (v * cos(p[2]), v * sin(p[2]), v * tan(γ) / d)  # noqa: E731
    end = solve_ivp(rates, (0, T), (0, 0, 0), rtol=1e-11, atol=1e-12).y[:, -1]
    assert exact(Pose(0, 0, 0), (distance, turn), 1.0) == pytest.approx(tuple(end), abs=1e-8)


def test_rear_wheels_share_the_turn_or_do_not() -> None:
    γ = 0.3
    left, right, angle = tricycle(track=0.6, wheel_radius=0.1).wheel_speeds(Command(1.0, γ))
    assert angle == γ
    assert left == pytest.approx((1 - 0.3 * tan(γ)) / 0.1)
    assert right == pytest.approx((1 + 0.3 * tan(γ)) / 0.1)
    assert tricycle(differential=False).wheel_speeds(Command(1.0, γ)) == pytest.approx((10, 10, γ))
    assert tricycle().drives == ("left", "right", "steering")
    assert tricycle(drive="front").drives == ("traction", "steering")


@DRIVES
def test_at_standstill_the_wheel_turns_and_waits(drive: str) -> None:
    robot = tricycle(drive=drive)
    assert robot.command(0.0, 0.0) == (0.0, 0.0)
    assert robot.command(0.0, 0.4) == (0.0, pi / 4)
    assert robot.command(0.0, -0.4) == (0.0, -pi / 4)
    assert [robot.command(v, 0.4)[1] for v in (1e-17, -1e-17)] == [pi / 4] * 2, "a rounded zero has no sign"
    assert robot.twist(Command(0.0, 0.7)) == (0.0, 0.0)
    assert robot.travel([0.0] * (len(robot.drives) - 1) + [0.5]) == (0.0, 0.0)


def test_in_reverse_the_steering_is_that_of_the_curve_not_of_atan2() -> None:
    """(3.15) as printed gives an angle beyond a quarter turn."""
    assert steering((-1.0, 0.5), 1.0) == pytest.approx(-0.4636476)
    for drive in ("front", "rear"):
        robot = tricycle(drive=drive)
        assert robot.twist(robot.command(-1.0, 0.5)) == pytest.approx((-1.0, 0.5))


def test_a_quarter_turn_is_finite_for_a_rear_drive_and_exact_for_a_front_drive() -> None:
    for γ in (pi / 2, -pi / 2, 3.0, inf):
        v, w = rear_drive(Command(1.0, γ), 1.0)
        assert v == 1.0
        assert abs(w) == pytest.approx(tan(STEEPEST))
    assert front_drive(Command(1.0, pi / 2), 2.0) == pytest.approx((0.0, 0.5), abs=1e-15)


@given(st.sampled_from([1.0, -1.0]), st.floats(1.4, STEEPEST), st.floats(1e-3, 2.0) | st.floats(-2.0, -1e-3))
def test_near_a_right_angle_all_is_finite_and_comes_back(side: float, γ: float, v: float) -> None:
    """As far as the axis turns, forward then inverse is the same twist, and so are the wheels' speeds."""
    for drive in ("front", "rear"):
        robot = tricycle(drive=drive, max_steering=STEEPEST, max_speed=100.0)
        twist = robot.twist(Command(v, side * γ))
        again = robot.command(*twist)
        assert robot.twist(again) == pytest.approx(twist, rel=1e-6, abs=1e-9)
        targets = robot.wheel_speeds(again)
        assert all(map(isfinite, targets))
        assert robot.travel(targets) == pytest.approx(twist, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("w", [0.4, -0.4, 1e300])
def test_as_the_speed_vanishes_the_axis_turns_to_its_limit(w: float) -> None:
    """The inverse has no jump towards standstill, but for the one between ahead and in reverse."""
    limit = copysign(pi / 4, w)
    for drive in ("front", "rear"):
        robot = tricycle(drive=drive)
        for v, angle in ((1e-3, limit), (0.0, limit), (-0.0, limit), (-1e-3, -limit)):
            assert robot.command(v, w)[1] == pytest.approx(angle)
            assert robot.twist(robot.command(v, w)) == pytest.approx((v, v * tan(angle)), abs=1e-15)


@DRIVES
def test_limits_hold_and_the_axle_keeps_its_speed(drive: str) -> None:
    robot = tricycle(drive=drive, max_speed=5.0)
    command = robot.command(1.0, 30.0)
    assert command[1] == pi / 4
    assert robot.twist(command) == pytest.approx((1.0, 1.0))
    assert robot.limited(Command(9.0, -9.0)) == (5.0, -pi / 4)


@given(st.floats(-1e308, 1e308), st.floats(-1e308, 1e308))
def test_no_twist_is_beyond_the_limits(v: float, w: float) -> None:
    command = tricycle(drive="front").command(v, w)
    assert abs(command[1]) <= pi / 4
    assert abs(command[0]) <= 1.74


def test_nan_stays_nan_instead_of_a_limit() -> None:
    """So that the run ends as diverged, not at full speed."""
    assert not isfinite(tricycle().limited(Command(nan, nan))[0])


@pytest.mark.parametrize("bad", [{"wheelbase": 0.0}, {"max_steering": pi / 2}, {"drive": "side"}, {"w": 1}])
def test_bad_settings_are_refused(bad: dict[str, object]) -> None:
    with pytest.raises(ValidationError):
        TricycleSpec.model_validate(bad)


def test_any_controller_of_a_twist_drives_a_tricycle() -> None:
    class Turning:
        def step(self, t: int, estimate: Estimate) -> Command:
            return Command(1.0, float(estimate.mean[2]) + t)

    robot = tricycle(wheelbase=2.0)
    believed = Estimate(0, np.full(3, 0.25), NO_COVARIANCE)
    assert robot.twist(Steered(Turning(), robot).step(0, believed)) == pytest.approx((1.0, 0.25))
