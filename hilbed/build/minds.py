"""Estimators and controllers by their kind."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from hilbed.ports import Controller, Estimator, Reference
from hilbed.spec import Point
from hilbed.types import Command, Estimate, Nanos, Pose


class Surroundings(NamedTuple):
    """What an estimator knows from the start: beacons (m, map), its pose, the sensor's mount (m, robot)."""

    beacons: Sequence[Point]
    start: Pose
    mount: Point


class Idle:
    """The controller of a robot that cannot be controlled, such as a recorded one."""

    def step(self, t: Nanos, estimate: Estimate) -> Command:  # noqa: ARG002
        """Asks for standstill."""
        return Command(0.0, 0.0)


def make_estimator(spec: Any, known: Surroundings) -> Estimator:
    """Returns the estimator of a scenario's block."""
    return ESTIMATORS[spec.kind](spec, known)


def make_controller(spec: Any, reference: Reference | None, period: Nanos) -> Controller:
    """Returns the controller of a scenario's block; the idle one where there is no block."""
    if spec is None or reference is None:
        return Idle()
    return CONTROLLERS[spec.kind](spec, reference, period)


def _ekf(spec: Any, known: Surroundings) -> Estimator:
    from hilbed.estimation.ekf import Ekf

    return Ekf(spec, known.beacons, known.start, known.mount)


def _odometry(spec: Any, known: Surroundings) -> Estimator:
    from hilbed.estimation.dead_reckoning import DeadReckoning

    return DeadReckoning(spec, known.start)


def _lqr(spec: Any, reference: Reference, period: Nanos) -> Controller:
    from hilbed.control.lqr import Lqr

    return Lqr(spec, reference, period)


def _open_loop(_: Any, reference: Reference, __: Nanos) -> Controller:
    from hilbed.control.open_loop import OpenLoop

    return OpenLoop(reference)


ESTIMATORS: dict[str, Callable[[Any, Surroundings], Estimator]] = {"ekf": _ekf, "odometry": _odometry}

CONTROLLERS: dict[str, Callable[[Any, Reference, Nanos], Controller]] = {"lqr": _lqr, "open_loop": _open_loop}
