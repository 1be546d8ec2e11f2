"""Particle filter of the pose from odometry and measured positions or poses."""

from __future__ import annotations

from collections.abc import Sequence
from math import nan

import numpy as np

from hilbed.angles import wrap
from hilbed.clock import nanos
from hilbed.estimation.cloud import WayNoise, cloud_of, lattice, predicted, summary
from hilbed.estimation.dead_reckoning import extrapolation, usable
from hilbed.estimation.importance import importance, squared_distances
from hilbed.estimation.particle_spec import ParticleFilterSpec
from hilbed.estimation.readable import readable
from hilbed.estimation.resampling import RESAMPLERS, effective_sample_size
from hilbed.estimation.trail import Trail, arc_motion, carried, inverse
from hilbed.types import Array, Estimate, Innovation, Nanos, Odometry, Pose, Reading, Rng

SIZES = {"position": 2, "pose": 3}


class ParticleFilter:
    """Lages & Alves (2017), "Pose estimation by particle filter", for readings of any age.

    A late reading is compared with where each particle was, by told odometry, when it was exposed.
    `ignored` counts odometry and readings that cannot be used: not finite, of an unknown kind, with a
    standard deviation that is not positive, from the future or older than the memory; `unexplained` those
    that gave every particle the weight zero, and left the cloud as it was; `recovered` how often the cloud
    was drawn anew. `effective` is the effective sample size at the last reading, NaN before the first.
    """

    def __init__(self, spec: ParticleFilterSpec, start: Pose, rng: Rng) -> None:
        """start: pose at t = 0, the centre of the first cloud; rng: for motion and resampling."""
        self._spec = spec
        self._rng = rng
        self._noise = WayNoise(spec.along_noise, spec.turn_noise)
        self._resampled = RESAMPLERS[spec.resampling]
        self._cloud = lattice(start, spec.particles, spec.side)
        self._trail = Trail(nanos(spec.memory))
        self._in_a_row = 0
        self.ignored = self.unexplained = self.recovered = 0
        self.effective = nan

    def counts(self) -> dict[str, float]:
        """Returns the counters, and the effective sample size at the last reading."""
        return {
            "ignored": self.ignored,
            "unexplained": self.unexplained,
            "recovered": self.recovered,
            "effective": self.effective,
        }

    def step(self, t: Nanos, odometry: Odometry, readings: Sequence[Reading]) -> Estimate:
        """Takes what has arrived by `t`; returns the cloud at `t`, extrapolated beyond the odometry."""
        self._move(odometry)
        innovations = []
        for reading in sorted(readings, key=lambda reading: reading.t):
            if reading.t <= t and readable(reading, SIZES) and self._trail.remembers(reading.t):
                innovations.append(self._update(reading, odometry))
            else:
                self.ignored += 1
        cloud = carried(self._cloud, arc_motion(*extrapolation(t - self._trail.end, odometry)))
        return Estimate(t, *summary(cloud), tuple(innovations), cloud)

    def _move(self, odometry: Odometry) -> None:
        if not usable(odometry):
            self.ignored += 1
            return
        self._trail.extend(odometry.t, odometry.distance, odometry.turn)
        self._cloud = predicted(self._cloud, odometry.distance, odometry.turn, self._noise, self._rng)

    def _update(self, reading: Reading, odometry: Odometry) -> Innovation:
        """Resamples by a reading; returns how its prediction by the whole cloud compared with it."""
        std = self._std(reading)
        motion = self._motion(reading.t, odometry)
        then = carried(self._cloud, motion)
        weights = importance(squared_distances(then, reading.value, std))
        nis = _nis(then, reading.value, std)
        if weights is None:
            self._refuse(reading, then, inverse(motion))
        else:
            self._in_a_row = 0
            self.effective = effective_sample_size(weights)
            chosen = self._resampled(weights, self._rng)
            self._cloud = self._cloud.T[:, chosen].T
        return Innovation(reading.t, nis, len(reading.value), weights is not None)

    def _std(self, reading: Reading) -> tuple[float, ...]:
        own = (self._spec.position_std, self._spec.position_std, self._spec.yaw_std)
        return tuple(mine or told for mine, told in zip(own, reading.std, strict=False))

    def _motion(self, t: Nanos, odometry: Odometry) -> Pose:
        """Returns the motion that carries the cloud from its time to an exposure at `t`."""
        if t > self._trail.end:
            return arc_motion(*extrapolation(t - self._trail.end, odometry))
        return inverse(self._trail.since(t))

    def _refuse(self, reading: Reading, then: Array, since: Pose) -> None:
        """Leaves the cloud as it is, or draws it anew where refusing has become a habit.

        then: the cloud at the exposure; since: the motion from there to the cloud's time.
        """
        self.unexplained += 1
        self._in_a_row += 1
        if self._spec.recover_after is None or self._in_a_row < self._spec.recover_after:
            return
        self._in_a_row = 0
        self.recovered += 1
        drawn = then.T.copy()
        for k, (value, std) in enumerate(zip(reading.value, self._std(reading), strict=True)):
            drawn[k] = value + std * self._rng.standard_normal(len(drawn[k]))
        self._cloud = carried(cloud_of(*drawn), since)


def _nis(cloud: Array, value: Sequence[float], std: Sequence[float]) -> float:
    """Returns vᵀ S⁻¹ v of the cloud's mean, S its covariance and the reading's."""
    size = len(value)
    mean, covariance = summary(cloud)
    v = np.array(value) - mean[:size]
    v[2:] = [wrap(angle) for angle in v[2:].tolist()]
    S = covariance[:size, :size] + np.diag(np.square(std))
    return float(v @ np.linalg.solve(S, v))
