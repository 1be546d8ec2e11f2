from __future__ import annotations

from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed.estimation.motion import OdometryModel, motion
from hilbed.poses import moved
from hilbed.types import Pose
from tests.estimation.experiment import exact_arc

angles = st.floats(-3, 3)
ways = st.floats(-0.5, 0.5)


def test_many_small_increments_close_a_circle() -> None:
    pose = Pose(1.0, -2.0, 0.3)
    for _ in range(1000):
        pose = moved(pose, 2 * pi * 0.8 / 1000, 2 * pi / 1000)
    assert pose == pytest.approx((1.0, -2.0, 0.3), abs=1e-9)


@given(angles, ways, st.floats(-0.02, 0.02))
def test_small_increments_follow_the_exact_arc(yaw: float, way: float, turn: float) -> None:
    assert moved(Pose(0, 0, yaw), way, turn) == pytest.approx(
        exact_arc(Pose(0, 0, yaw), way, turn, 0.0), abs=1e-5
    )


@given(angles, ways, angles)
def test_jacobian_is_the_derivative_of_the_change(yaw: float, way: float, turn: float) -> None:
    model = OdometryModel(direction=0.1, distance_scale=1.1, turn_scale=0.9)
    step, h = motion(yaw, way, turn, model), 1e-6
    by_yaw = (motion(yaw + h, way, turn, model).change - motion(yaw - h, way, turn, model).change) / (2 * h)
    np.testing.assert_allclose(step.F - np.eye(3), np.outer(by_yaw, (0, 0, 1)), atol=1e-8)


@given(angles, ways, angles)
def test_noise_is_that_of_way_and_turn_carried_over(yaw: float, way: float, turn: float) -> None:
    model, h = OdometryModel(distance_noise=0.3, heading_noise=0.2, turn_noise=0.1), 1e-6
    by_way = (motion(yaw, way + h, turn, model).change - motion(yaw, way - h, turn, model).change) / (2 * h)
    by_turn = (motion(yaw, way, turn + h, model).change - motion(yaw, way, turn - h, model).change) / (2 * h)
    expected = 0.09 * abs(way) * np.outer(by_way, by_way)
    expected += (0.04 * abs(way) + 0.01 * abs(turn)) * np.outer(by_turn, by_turn)
    np.testing.assert_allclose(motion(yaw, way, turn, model).Q, expected, atol=1e-8)


def test_a_step_cut_in_many_gains_no_doubt_of_yaw() -> None:
    model = OdometryModel()
    once = motion(0.2, 0.4, 0.1, model).Q[2, 2]
    assert sum(motion(0.2, 0.04, 0.01, model).Q[2, 2] for _ in range(10)) == pytest.approx(once)
