"""The paper's closed loop: stochastic unicycle by Runge–Kutta, exact encoders, GPS every 200 ms."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi
from typing import NamedTuple

from hilbed.angles import wrap
from hilbed.control.cloud import CloudControl
from hilbed.control.cloud_spec import CloudSpec
from hilbed.control.point import PointSpec
from hilbed.estimation.particle_filter import ParticleFilter
from hilbed.estimation.particle_spec import ParticleFilterSpec
from hilbed.plant.kinematics import TwistNoise, advanced, rk4
from hilbed.rng import stream
from hilbed.types import Command, Estimate, Odometry, Pose, Reading

PERIOD = 50_000_000  # ns
T = 0.05
GOAL = Pose(1.0, 3.0, -pi / 2)
START = Pose(4.0, 0.0, pi)
NOISE = TwistNoise(0.005, 0.1745)
GPS_STD = (0.1, 0.1, pi / 180)
GUARDED = CloudSpec()
PRINTED = CloudSpec(guard=0.0)


class Moment(NamedTuple):
    """One cycle: true pose, belief after the readings, command that is then applied for T."""

    truth: Pose
    estimate: Estimate
    command: Command


def experiment(
    seed: int,
    start: Pose = START,
    control: CloudSpec = GUARDED,
    filtering: ParticleFilterSpec = ParticleFilterSpec(),  # noqa: B008 (frozen)
) -> Iterator[Moment]:
    """Yields the cycles of one run without end; the first GPS reading comes at k = 3, as in Fig. 7 and 8."""
    goal = PointSpec(kind="point", pose=GOAL).build()
    estimator = ParticleFilter(filtering, start, stream(seed, "estimator"))
    controller = CloudControl(control, goal)
    plant, gps = stream(seed, "plant"), stream(seed, "gps")
    truth, command, k = start, Command(0.0, 0.0), 0
    while True:
        t = k * PERIOD
        odometry = Odometry(t, T * command.v, T * command.w, *command)
        readings = [_gps(t, truth, gps.standard_normal(3).tolist())] if k % 4 == 3 else []
        estimate = estimator.step(t, odometry, readings)
        command = controller.step(t, estimate)
        yield Moment(truth, estimate, command)
        truth = advanced(truth, NOISE.disturbed(command, plant), T, rk4, 4)
        k += 1


def _gps(t: int, truth: Pose, noise: list[float]) -> Reading:
    x, y, yaw = (true + std * n for true, std, n in zip(truth, GPS_STD, noise, strict=True))
    return Reading("pose", t, t, (x, y, wrap(yaw)), GPS_STD)


def final(seed: int, cycles: int) -> Pose:
    """Returns the true pose at k = `cycles`."""
    for k, moment in enumerate(experiment(seed)):
        if k == cycles:
            return moment.truth
    raise AssertionError
