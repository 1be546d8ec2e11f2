"""The control cycle on an ideal plant: what the loop does, with estimates that may have no covariance."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from hilbed.plant.kinematic import IdealBase, KinematicPlant, Vehicle
from hilbed.ports import Controller, Estimator
from hilbed.types import Array, Command, Estimate, Nanos, Odometry, Pose, Reading

Sensor = Callable[[Nanos, Pose], list[Reading]]


class Experiment(NamedTuple):
    """start pose, period and duration (ns)."""

    vehicle: Vehicle
    start: Pose
    period: Nanos
    duration: Nanos


class Run(NamedTuple):
    """Rows at t = 0, T, …: poses (N, 3), beliefs (N, 3), commands (N, 2)."""

    truth: Array
    mean: Array
    command: Array
    estimates: list[Estimate]


def run(
    experiment: Experiment,
    estimator: Estimator,
    controller: Controller,
    sensor: Sensor,
) -> Run:
    vehicle, start, period, duration = experiment
    plant = KinematicPlant(start, vehicle)
    base = IdealBase(plant, vehicle)
    rows: list[tuple[Pose, Estimate, Command]] = []
    for t in range(0, duration + 1, period):
        pose = plant.truth().pose
        estimate = estimator.step(t, base.read(t), sensor(t, pose))
        command = controller.step(t, estimate)
        rows.append((pose, estimate, command))
        base.write(t, command)
        plant.advance(t, t + period)
    poses, estimates, commands = zip(*rows, strict=True)
    return Run(
        np.array(poses),
        np.array([e.mean for e in estimates]),
        np.array(commands),
        list(estimates),
    )


class Known:
    """An estimator that is told the truth by the sensor: state feedback."""

    def step(self, t: Nanos, odometry: Odometry | None, readings: Sequence[Reading]) -> Estimate:  # noqa: ARG002
        return Estimate(t, np.array(readings[0].value), np.zeros((3, 3)))


def pose_sensor(t: Nanos, pose: Pose) -> list[Reading]:
    return [Reading("pose", t, t, tuple(pose), (0.0, 0.0, 0.0))]
