from __future__ import annotations

from math import pi

import numpy as np
import pytest

from hilbed.control.cloud import CloudControl
from hilbed.control.cloud_spec import CloudSpec
from hilbed.control.point import PointSpec
from hilbed.control.stabilisation import Gains, stabilising
from hilbed.types import Array, Command, Estimate, Pose

GOAL = PointSpec(kind="point", pose=(1.0, 3.0, -pi / 2))
SPEC = CloudSpec()


def estimate(cloud: Array) -> Estimate:
    return Estimate(0, cloud.mean(axis=0), np.eye(3), (), cloud)


def test_of_two_groups_of_poses_the_larger_one_decides() -> None:
    """Bimodal belief: the mean of all would drive to where no particle is."""
    rng = np.random.default_rng(1)
    few, many = np.array((1.0, 3.4, -1.0)), np.array((1.5, 2.7, 2.0))
    cloud = np.concatenate((few + 0.003 * rng.normal(size=(40, 3)), many + 0.003 * rng.normal(size=(60, 3))))
    command = CloudControl(SPEC, GOAL.build()).step(0, estimate(cloud))
    alone = CloudControl(SPEC, GOAL.build()).step(0, Estimate(0, many, np.eye(3)))
    assert command == pytest.approx(alone, abs=0.02)
    mean = CloudControl(SPEC, GOAL.build()).step(0, Estimate(0, cloud.mean(axis=0), np.eye(3)))
    assert abs(command.w - mean.w) > 0.2


def test_the_command_is_one_of_the_clouds_own_with_most_support_inside_the_ellipse() -> None:
    cloud = np.random.default_rng(2).normal(size=(300, 3)) * 0.03 + (1.2, 2.8, -1.0)
    u1, u2 = stabilising(cloud, Pose(*GOAL.pose), Gains())
    inside = ((u1[:, None] - u1) / 0.05) ** 2 + ((u2[:, None] - u2) / 0.2) ** 2 < 1
    best = np.argmax(inside.sum(axis=1))
    assert CloudControl(SPEC, GOAL.build()).step(0, estimate(cloud)) == Command(u1[best], u2[best])


def test_an_estimate_without_a_cloud_is_one_particle() -> None:
    pose = np.array((1.3, 2.9, -1.0))
    control = CloudControl(SPEC, GOAL.build())
    assert control.step(0, Estimate(0, pose, np.eye(3))) == control.step(0, estimate(pose[None]))


def test_the_chosen_command_is_limited() -> None:
    far = np.array((40.0, 3.0, 1.0))
    v, w = CloudControl(SPEC, GOAL.build()).step(0, Estimate(0, far, np.eye(3)))
    assert abs(v) + 0.25 * abs(w) == pytest.approx(0.471)


def test_a_point_stands_where_it_is() -> None:
    reference = PointSpec(kind="point", pose=(1.0, 3.0, 3 * pi / 2)).build()
    for t in (0, 10**12):
        assert reference.at(t).pose == pytest.approx((1.0, 3.0, -pi / 2))
        assert reference.at(t)[1:] == (0.0, 0.0)
    assert reference.extent() == (1.0, 3.0, 1.0, 3.0) == GOAL.path().extent()
