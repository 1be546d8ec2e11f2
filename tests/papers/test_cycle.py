"""The ideal plant under the bench's own control cycle."""

from __future__ import annotations

import numpy as np

from hilbed.control.legs import LegsSpec
from hilbed.control.lyapunov_spec import LyapunovTrackingSpec
from hilbed.control.lyapunov_tracking import LyapunovTracking
from hilbed.control.steered import Steered
from hilbed.cost import Cost
from hilbed.estimation.dead_reckoning import DeadReckoning
from hilbed.estimation.specs import DeadReckoningSpec
from hilbed.loop import Rig
from hilbed.loop import run as run_rig
from hilbed.plant.kinematic import IdealBase, KinematicPlant, Vehicle
from hilbed.robots.tricycle import Tricycle, TricycleSpec
from hilbed.types import Pose
from tests.papers.ideal import Experiment, run

PERIOD, START = 100_000_000, Pose(-20.0, 3.0, 0.0)


def test_the_loop_runs_a_papers_experiment_as_it_runs_the_bench() -> None:
    """Same estimator, controller and base; the same bits as the tests' own plain loop."""
    robot, reference = Tricycle(TricycleSpec()), LegsSpec().build()
    vehicle = Vehicle(robot.twist, robot.limited)

    def minds() -> tuple[DeadReckoning, Steered]:
        law = LyapunovTracking(LyapunovTrackingSpec(), reference)
        return DeadReckoning(DeadReckoningSpec(), START), Steered(law, robot)

    plant = KinematicPlant(START, vehicle)
    estimator, controller = minds()
    rig = Rig(IdealBase(plant, vehicle), (), estimator, controller, plant, PERIOD, Cost())
    cycles = list(run_rig(rig, 50 * 10**9))
    plain = run(Experiment(vehicle, START, PERIOD, 50 * 10**9), *minds(), lambda _, __: [])
    np.testing.assert_array_equal([c.truth.pose for c in cycles], plain.truth)
    np.testing.assert_array_equal([c.command for c in cycles], plain.command)
    end = reference.at(50 * 10**9).pose
    assert np.hypot(*(plain.truth[-1] - end)[:2]) < 0.1
