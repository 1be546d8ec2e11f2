"""Odometry alone, believed as told: what correction by the camera is compared with."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hilbed.estimation.motion import predicted
from hilbed.estimation.specs import DeadReckoningSpec
from hilbed.types import Estimate, Nanos, Odometry, Pose, Reading

FARTHEST = 1e3  # m or rad in one increment: beyond it the odometer is broken, not fast


def usable(odometry: Odometry) -> bool:
    """Tells whether an increment is a number, and one that a wheeled robot can have moved by."""
    return abs(odometry.distance) < FARTHEST and abs(odometry.turn) < FARTHEST


def extrapolation(ahead: Nanos, odometry: Odometry) -> tuple[float, float]:
    """Returns the way (m) and turn (rad) of the next `ahead` ns; none if the speeds are unusable."""
    way, turn = odometry.v * ahead * 1e-9, odometry.w * ahead * 1e-9
    fine = abs(way) < FARTHEST and abs(turn) < FARTHEST  # false for NaN
    return (way, turn) if ahead > 0 and fine else (0.0, 0.0)


class DeadReckoning:
    """Integrates odometry from a known start; readings are not looked at.

    `ignored` counts increments that are not finite or not believable.
    """

    def __init__(self, spec: DeadReckoningSpec, start: Pose) -> None:
        self._model = spec.odometry.model()
        self._mean = np.array(start, dtype=float)
        self._covariance = np.diag(np.square(spec.initial_std))
        self.ignored = 0

    def counts(self) -> dict[str, float]:
        """Returns how much odometry and how many readings could not be used."""
        return {"ignored": self.ignored}

    def step(self, t: Nanos, odometry: Odometry, readings: Sequence[Reading]) -> Estimate:  # noqa: ARG002
        """Returns the pose at `t`: odometry up to its stamp, then its speeds."""
        if usable(odometry):
            step = odometry.distance, odometry.turn
            self._mean, self._covariance = predicted(self._mean, self._covariance, step, self._model)
        else:
            self.ignored += 1
        ahead = extrapolation(t - odometry.t, odometry)
        return Estimate(t, *predicted(self._mean, self._covariance, ahead, self._model))
