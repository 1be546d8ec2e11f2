"""State feedback: the pose as a sensor gives it, which papers without an estimator take for granted."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hilbed.angles import wrap
from hilbed.clock import nanos
from hilbed.estimation.dead_reckoning import extrapolation, usable
from hilbed.estimation.measured_spec import MeasuredSpec
from hilbed.estimation.no_covariance import NO_COVARIANCE
from hilbed.estimation.readable import readable
from hilbed.estimation.trail import Trail, arc_motion, compose
from hilbed.types import Estimate, Nanos, Odometry, Pose, Reading

SIZES = {"pose": 3}


class Measured:
    """The last "pose" reading, carried by odometry from its exposure on; until there is one, the start.

    `ignored` counts what cannot be used: odometry that is not finite, readings that are not, or are of
    another kind, older than the memory or the last one, or from the future.
    """

    def __init__(self, spec: MeasuredSpec, start: Pose) -> None:
        self._pose = start
        self._seen: Nanos = -1
        self._trail = Trail(nanos(spec.memory))
        self.ignored = 0

    def counts(self) -> dict[str, float]:
        """Returns how much odometry and how many readings could not be used."""
        return {"ignored": self.ignored}

    def step(self, t: Nanos, odometry: Odometry, readings: Sequence[Reading]) -> Estimate:
        """Takes what has arrived by `t`; returns the pose at `t`, extrapolated beyond the odometry."""
        self._move(odometry)
        for reading in sorted(readings, key=lambda reading: reading.t):
            self._take(t, reading)
        step = arc_motion(*extrapolation(t - max(self._trail.end, self._seen), odometry))
        x, y, yaw = compose(self._pose, step)
        return Estimate(t, np.array((x, y, wrap(yaw))), NO_COVARIANCE)

    def _move(self, odometry: Odometry) -> None:
        """Carries the pose over an increment, or over what of it comes after the last exposure."""
        if not usable(odometry) or odometry.t < self._trail.end:
            self.ignored += 1
            return
        since = max(self._trail.end, self._seen)
        self._trail.extend(odometry.t, odometry.distance, odometry.turn)
        if odometry.t > since:
            self._pose = compose(self._pose, self._trail.since(since))

    def _take(self, t: Nanos, reading: Reading) -> None:
        fresh = self._seen < reading.t <= t and self._trail.remembers(reading.t)
        if not (fresh and readable(reading, SIZES)):
            self.ignored += 1
            return
        x, y, yaw = reading.value
        self._seen = reading.t
        self._pose = compose(Pose(x, y, yaw), self._trail.since(reading.t))
