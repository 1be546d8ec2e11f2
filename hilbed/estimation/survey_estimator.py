"""The full-state filter of two landmarks at unknown distance as an estimator."""

from __future__ import annotations

from collections.abc import Sequence
from math import sin

import numpy as np

from hilbed.clock import nanos
from hilbed.estimation.bearing_observers import AXIS, FARTHEST, NEAREST
from hilbed.estimation.bearing_specs import SurveySpec
from hilbed.estimation.dead_reckoning import extrapolation, usable
from hilbed.estimation.no_covariance import NO_COVARIANCE
from hilbed.estimation.readable import readable
from hilbed.estimation.sights import Sight, angle, surveyed, surveyed_covariance
from hilbed.estimation.survey_filter import (
    Belief,
    corrected,
    moved_on,
    sights_covariance,
    started,
    surprise,
)
from hilbed.estimation.ways import Waiting, Way, split
from hilbed.poses import moved
from hilbed.types import Estimate, Innovation, Nanos, Odometry, Pose, Reading

SIZES = {"azimuth": 1}


class SurveyEstimator:
    """Landmarks as in `Bearings`: 0 is the map's origin, 1 is up its y axis. Readings need their names.

    It starts from the first exposure with both; until then the pose is the start as odometry carries it.
    So is the estimate's landmark distance unknown. `ignored` counts what cannot be used; `singular` readings
    of a landmark on the robot's axis, which hardly tell its distance; `held` those at which a distance was at
    its least or largest; `restarted` how often the covariance was no longer positive: then it starts afresh.
    """

    def __init__(self, spec: SurveySpec, start: Pose) -> None:
        self._spec = spec
        self._model = spec.odometry.model()
        self._start = start
        self._belief: Belief | None = None  # at the last exposure
        self._ahead: Belief | None = None  # after the way since then
        self._first: Reading | None = None
        self._since: list[Way] = []
        self._seen: Nanos = -1
        self._t: Nanos = 0
        self._memory = nanos(spec.memory)
        self._waiting = Waiting(self._memory)
        self.ignored = self.singular = self.held = self.restarted = 0

    def counts(self) -> dict[str, float]:
        """Returns how much could not be used, and what befell the filter."""
        return {
            "ignored": self.ignored,
            "singular": self.singular,
            "held": self.held,
            "restarted": self.restarted,
        }

    def step(self, t: Nanos, odometry: Odometry, readings: Sequence[Reading]) -> Estimate:
        """Takes what has arrived by `t`; returns the belief at `t`, extrapolated beyond the odometry."""
        self._move(odometry)
        ready, refused = self._waiting.due(readings, self._t)
        self.ignored += refused
        innovations = [self._take(reading) for reading in ready]
        ahead = extrapolation(t - self._t, odometry)
        if self._belief is None:
            return Estimate(t, np.array(moved(self._start, *ahead)), NO_COVARIANCE)
        if ready or self._ahead is None:
            self._ahead = self._through(self._belief, self._since)
        belief = moved_on(self._ahead, ahead, self._model)
        state = surveyed(belief.a, belief.b)
        covariance = surveyed_covariance(state, sights_covariance(belief))[:3, :3]
        told = tuple(innovation for innovation in innovations if innovation is not None)
        return Estimate(t, np.array(state[:3]), covariance, told, landmark_distance=state.l)

    def _move(self, odometry: Odometry) -> None:
        if not usable(odometry) or odometry.t < self._t:
            self.ignored += 1
        elif odometry.t > self._t:
            way = Way(self._t, odometry.t, odometry.distance, odometry.turn)
            self._t = odometry.t
            self._start = moved(self._start, way.distance, way.turn)
            self._since.append(way)
            self._ahead = self._ahead and self._through(self._ahead, [way])
            if self._since[0].end < way.end - self._memory:
                old = self._since.pop(0)
                self._seen = old.end
                self._belief = self._belief and self._through(self._belief, [old])

    def _take(self, reading: Reading) -> Innovation | None:
        """Measures; None where the reading starts the filter or cannot be used."""
        fits = reading.beacon in (0, 1) and readable(reading, SIZES)
        if not fits or reading.t < self._seen or (self._since and reading.t < self._since[0].start):
            self.ignored += 1
            return None
        if self._belief is None:
            self._begin(reading)
            return None
        landmark, phi, R = int(reading.beacon or 0), angle(reading.value[0]), self._variance(reading)
        before, self._since = split(self._since, reading.t)
        belief = self._through(self._belief, before)
        v, S = surprise(belief, landmark, phi, R)
        self.singular += abs(sin(phi)) < AXIS
        self.held += (belief.a, belief.b)[landmark].r in (NEAREST, FARTHEST)
        self._seen = reading.t
        self._belief = self._checked(corrected(belief, landmark, phi, R))
        return Innovation(reading.t, v * v / S, 1, True)

    def _checked(self, belief: Belief) -> Belief | None:
        """Returns the belief, None where its covariance is not positive."""
        positive = bool((belief.P.diagonal() > 0.0).all())
        self.restarted += not positive
        return belief if positive else None

    def _begin(self, reading: Reading) -> None:
        """Starts from two readings of one exposure; readings come in the order of their names."""
        first, self._first = self._first, reading
        if first is None or (first.t, first.beacon, reading.beacon) != (reading.t, 0, 1):
            return
        a, b = (
            Sight(guess, angle(seen.value[0]))
            for guess, seen in zip(self._spec.distances, (first, reading), strict=True)
        )
        self._belief = started(a, b, self._spec.distance_std, self._variance(reading) ** 0.5)
        _, self._since = split(self._since, reading.t)
        self._seen = reading.t

    def _variance(self, reading: Reading) -> float:
        return (self._spec.std or reading.std[0]) ** 2

    def _through(self, belief: Belief, ways: Sequence[Way]) -> Belief:
        for way in ways:
            belief = moved_on(belief, (way.distance, way.turn), self._model)
        return belief
