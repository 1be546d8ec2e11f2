"""Estimators and controllers by their kind."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from hilbed.control import OWN_COMMAND
from hilbed.control.ramps import Ramps
from hilbed.control.steered import Steered
from hilbed.ports import Controller, Estimator, Reference, Robot
from hilbed.spec import Point
from hilbed.types import Command, Estimate, Nanos, Pose, Rng

ESTIMATOR_STREAM = "estimator"


class Surroundings(NamedTuple):
    """What an estimator is given: beacons (m, map), its start, the sensor's mount (m, robot), chance."""

    beacons: Sequence[Point]
    start: Pose
    mount: Point
    rng: Rng


class Guidance(NamedTuple):
    """What a controller is given: a path, ns of the cycle, its robot (None for one that takes any twist)."""

    reference: Reference | None
    period: Nanos
    robot: Robot | None = None


class Idle:
    """The controller of a robot that cannot be controlled, such as a recorded one."""

    def step(self, t: Nanos, estimate: Estimate) -> Command:  # noqa: ARG002
        """Asks for standstill."""
        return Command(0.0, 0.0)


def make_estimator(spec: Any, known: Surroundings) -> Estimator:
    """Returns the estimator of a scenario's block."""
    return ESTIMATORS[spec.kind](spec, known)


def make_controller(spec: Any, guidance: Guidance) -> Controller:
    """Returns the controller of a scenario's block; the idle one where there is no block."""
    if spec is None:
        return Idle()
    controller = CONTROLLERS[spec.kind](spec, guidance)
    if spec.kind in OWN_COMMAND or guidance.robot is None:
        return controller
    return Steered(controller, guidance.robot)


def _ekf(spec: Any, known: Surroundings) -> Estimator:
    from hilbed.estimation.ekf import Ekf

    return Ekf(spec, known.beacons, known.start, known.mount)


def _odometry(spec: Any, known: Surroundings) -> Estimator:
    from hilbed.estimation.dead_reckoning import DeadReckoning

    return DeadReckoning(spec, known.start)


def _bearings(spec: Any, known: Surroundings) -> Estimator:
    from hilbed.estimation.bearings import Bearings

    return Bearings(spec, known.start)


def _survey(spec: Any, known: Surroundings) -> Estimator:
    from hilbed.estimation.survey_estimator import SurveyEstimator

    return SurveyEstimator(spec, known.start)


def _particles(spec: Any, known: Surroundings) -> Estimator:
    from hilbed.estimation.particle_filter import ParticleFilter

    return ParticleFilter(spec, known.start, known.rng)


def _attitude(spec: Any, known: Surroundings) -> Estimator:
    from hilbed.estimation.attitude_estimator import Attitude

    return Attitude(spec, known.start)


def _measured(spec: Any, known: Surroundings) -> Estimator:
    from hilbed.estimation.measured import Measured

    return Measured(spec, known.start)


ESTIMATORS: dict[str, Callable[[Any, Surroundings], Estimator]] = {
    "ekf": _ekf, "odometry": _odometry, "bearing_lyapunov": _bearings, "bearing_kalman": _bearings,
    "bearing_luenberger": _bearings, "bearing_survey": _survey, "particles": _particles,
    "attitude": _attitude, "measured": _measured,
}  # fmt: skip


def _lqr(spec: Any, guidance: Guidance) -> Controller:
    from hilbed.control.lqr import Lqr

    return Lqr(spec, _followed(guidance), guidance.period)


def _open_loop(_: Any, guidance: Guidance) -> Controller:
    from hilbed.control.open_loop import OpenLoop

    return OpenLoop(_followed(guidance))


def _lyapunov(spec: Any, guidance: Guidance) -> Controller:
    from hilbed.control.lyapunov_tracking import LyapunovTracking

    return LyapunovTracking(spec, _followed(guidance))


def _path_following(spec: Any, _: Guidance) -> Controller:
    from hilbed.control.path_following import PathFollowing

    return PathFollowing(spec)


def _ramps(spec: Any, guidance: Guidance) -> Controller:
    return Ramps(spec) if guidance.robot is None else Ramps(spec, guidance.robot.limited)


def _cloud(spec: Any, guidance: Guidance) -> Controller:
    from hilbed.control.cloud import CloudControl

    return CloudControl(spec, _followed(guidance))


def _front_point(spec: Any, guidance: Guidance) -> Controller:
    from hilbed.control.front_point import FrontPoint

    return FrontPoint(spec, _followed(guidance))


def _followed(guidance: Guidance) -> Reference:
    """Returns the reference, which the scenario's checks have made sure of."""
    assert guidance.reference is not None
    return guidance.reference


CONTROLLERS: dict[str, Callable[[Any, Guidance], Controller]] = {
    "lqr": _lqr, "open_loop": _open_loop, "lyapunov": _lyapunov, "path_following": _path_following,
    "ramps": _ramps, "cloud": _cloud, "front_point": _front_point,
}  # fmt: skip
