"""One run as in Fig. 7 to 13, and what the printed law does to the yaw."""

from __future__ import annotations

from itertools import islice
from math import hypot

import numpy as np
import pytest

from hilbed.angles import wrap
from hilbed.types import Pose
from tests.lages2017.experiment import GOAL, PRINTED, experiment, final


def off(pose: Pose) -> tuple[float, float]:
    return hypot(pose.x - GOAL.x, pose.y - GOAL.y), abs(wrap(pose.yaw - GOAL.yaw))


def test_belief_and_wheels_along_one_run() -> None:
    """Fig. 7, 8 and 10: the first readings halve the cloud, k = 50 finds it small round the robot."""
    moments = list(islice(experiment(3), 400))
    spread = [float(np.sqrt(np.trace(m.estimate.covariance[:2, :2]))) for m in moments]
    assert spread[2] == pytest.approx(np.sqrt(2 / 12) * (31 / 29) ** 0.5, rel=0.01)  # 30 points, edges in
    assert spread[3] < spread[2] / 2
    assert spread[50] < 0.06
    errors = [hypot(*(m.estimate.mean[:2] - m.truth[:2])) for m in moments[50:]]
    assert max(errors) < 0.08
    assert max(abs(m.command.v) + 0.25 * abs(m.command.w) for m in moments) <= 0.471 * (1 + 1e-12)


def test_the_robot_comes_home_backwards() -> None:
    """Fig. 12 and 13: it ends with a negative speed and settles at the goal's yaw."""
    moments = list(islice(experiment(3), 700))
    assert np.mean([m.command.v for m in moments[100:300]]) < -0.1
    assert max(off(m.truth)[0] for m in moments[600:]) < 0.06
    assert max(off(m.truth)[1] for m in moments[600:]) < 0.02


def test_with_the_printed_law_the_yaw_does_not_settle() -> None:
    """The position does; near the goal ψ is noise, and the robot turns after it."""
    moments = list(islice(experiment(3, control=PRINTED), 1000))[600:]
    assert max(off(m.truth)[0] for m in moments) < 0.1
    assert max(off(m.truth)[1] for m in moments) > 1.0
    assert np.mean([off(m.truth)[1] > 0.1 for m in moments]) > 0.5


def test_a_run_is_the_same_to_the_bit() -> None:
    assert final(4, cycles=60) == final(4, cycles=60) != final(5, cycles=60)
