from __future__ import annotations

from collections.abc import Callable
from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed.angles import wrap
from hilbed.estimation.motion import predicted
from hilbed.estimation.odometry_model import OdometryModel
from hilbed.poses import moved
from hilbed.types import Array, Pose
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


MODEL = OdometryModel(0.1, 1.1, 0.9, distance_noise=0.3, heading_noise=0.2, turn_noise=0.1)
NO_DOUBT = np.zeros((3, 3))


def slope(function: Callable[[float], Array]) -> Array:
    """Returns the derivative at 0; yaw may wrap in between."""
    change = function(1e-6) - function(-1e-6)
    change[2] = wrap(change[2])
    return change / 2e-6


@given(angles, ways, angles)
def test_covariance_is_carried_by_the_derivatives_of_the_mean(yaw: float, way: float, turn: float) -> None:
    """F P Fᵀ + G V Gᵀ with F and G from differences of the predicted mean."""
    root = np.array([[0.3, 0.0, 0.0], [0.1, 0.2, 0.0], [-0.2, 0.1, 0.4]])
    before, start = root @ root.T, np.array((1.0, -2.0, yaw))
    _, after = predicted(start, before, (way, turn), MODEL)

    def mean(offset: Array, ds: float = 0.0, dturn: float = 0.0) -> Array:
        return predicted(start + offset, NO_DOUBT, (way + ds, turn + dturn), MODEL)[0]

    F = np.column_stack([slope(lambda h, axis=axis: mean(h * axis)) for axis in np.eye(3)])
    by_way, by_turn = slope(lambda h: mean(np.zeros(3), ds=h)), slope(lambda h: mean(np.zeros(3), dturn=h))
    ds, turned = 1.1 * abs(way), 0.9 * abs(turn)
    noise = 0.09 * ds * np.outer(by_way, by_way) / 1.1**2
    noise += (0.04 * ds + 0.01 * turned) * np.outer(by_turn, by_turn) / 0.9**2
    np.testing.assert_allclose(after, F @ before @ F.T + noise, atol=1e-8)
    np.testing.assert_array_equal(after, after.T)


def test_a_step_cut_in_many_gains_no_doubt_of_yaw() -> None:
    def doubt(way: float, turn: float) -> float:
        return float(predicted(np.array((0.0, 0.0, 0.2)), NO_DOUBT, (way, turn), OdometryModel())[1][2, 2])

    assert sum(doubt(0.04, 0.01) for _ in range(10)) == pytest.approx(doubt(0.4, 0.1))
