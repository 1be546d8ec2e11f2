"""The pose and the distance of two landmarks, both unknown, from their bearings: Ishikawa & Sampei (1994)."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite

import numpy as np

from hilbed.angles import wrap
from hilbed.clock import nanos
from hilbed.estimation.bearing_observers import State
from hilbed.estimation.bearing_specs import BearingsSpec
from hilbed.estimation.bearing_track import Track
from hilbed.estimation.dead_reckoning import extrapolation, usable
from hilbed.estimation.no_covariance import NO_COVARIANCE
from hilbed.estimation.readable import readable
from hilbed.estimation.sights import Sight, Survey, angle, surveyed, surveyed_covariance
from hilbed.estimation.ways import Waiting, Way
from hilbed.poses import moved
from hilbed.types import Array, Estimate, Innovation, Nanos, Odometry, Pose, Reading

SIZES = {"azimuth": 1}


class Bearings:
    """One observer a landmark, fed with azimuths; A, index 0, is the map's origin, B is up its y axis.

    Readings are taken at their exposure; one without a name goes to the landmark that is expected nearest to
    it. The estimate's landmark distance is NaN until both were seen. `ignored` counts what cannot be used:
    odometry and readings that are not finite, of another kind or beacon, nameless before both were seen, out
    of order, too old or far ahead; for the other counts see `Track`. Until both were seen the pose is the
    start as odometry carries it.
    """

    def __init__(self, spec: BearingsSpec, start: Pose) -> None:
        self._tracks = [
            Track(spec.observer(), guess, spec.step, nanos(spec.memory)) for guess in spec.distances
        ]
        self._start = start
        self._t: Nanos = 0
        self._waiting = Waiting(nanos(spec.memory))
        self.ignored = 0

    def counts(self) -> dict[str, float]:
        """Returns how much could not be used, and what befell the observers of both landmarks."""
        return {
            "ignored": self.ignored,
            "singular": sum(track.singular for track in self._tracks),
            "held": sum(track.held for track in self._tracks),
            "restarted": sum(track.restarted for track in self._tracks),
        }

    def step(self, t: Nanos, odometry: Odometry, readings: Sequence[Reading]) -> Estimate:
        """Takes what has arrived by `t`; returns the belief at `t`, extrapolated beyond the odometry."""
        self._move(odometry)
        innovations = self._measure(readings)
        return self._estimate(t, odometry, innovations)

    def _move(self, odometry: Odometry) -> None:
        if not usable(odometry) or odometry.t < self._t:
            self.ignored += 1
        elif odometry.t > self._t:
            way = Way(self._t, odometry.t, odometry.distance, odometry.turn)
            self._t = odometry.t
            self._start = moved(self._start, way.distance, way.turn)
            for track in self._tracks:
                track.move(way)

    def _measure(self, readings: Sequence[Reading]) -> tuple[Innovation, ...]:
        """Gives each reading exposed by now to its landmark, in the order of exposure; keeps the others."""
        ready, refused = self._waiting.due(readings, self._t)
        self.ignored += refused
        innovations = []
        for reading in ready:
            nis = self._take(reading)
            if nis is None:
                self.ignored += 1
            elif isfinite(nis):
                innovations.append(Innovation(reading.t, nis, 1, True))
        return tuple(innovations)

    def _take(self, reading: Reading) -> float | None:
        """Measures; returns the NIS, None where the reading cannot be used."""
        if not readable(reading, SIZES):
            return None
        phi = angle(reading.value[0])
        track = self._owner(reading.beacon, phi)
        return None if track is None else track.measure(reading.t, phi)

    def _owner(self, beacon: int | None, phi: float) -> Track | None:
        """Returns the track of a reading: as named, else the one that expects it nearest."""
        if beacon is not None:
            return self._tracks[beacon] if 0 <= beacon < len(self._tracks) else None
        expected = [track.now for track in self._tracks]
        if any(state is None for state in expected):
            return None
        return min(self._tracks, key=lambda track: abs(wrap(phi - track.measured())))

    def _estimate(self, t: Nanos, odometry: Odometry, innovations: tuple[Innovation, ...]) -> Estimate:
        step = extrapolation(t - self._t, odometry)
        if any(track.now is None for track in self._tracks):
            return Estimate(t, np.array(moved(self._start, *step)), NO_COVARIANCE, innovations)
        states = [track.ahead(*step) for track in self._tracks]
        ahead = [wrap(s[1] - (track.now or s)[1]) for s, track in zip(states, self._tracks, strict=True)]
        sights = [
            Sight(s[0], s[1] if len(s) > 2 else wrap(track.measured() + turned))
            for s, track, turned in zip(states, self._tracks, ahead, strict=True)
        ]
        survey = surveyed(sights[0], sights[1])
        covariance = _covariance(survey, states)
        return Estimate(t, np.array(survey[:3]), covariance, innovations, landmark_distance=survey.l)


def _covariance(survey: Survey, states: Sequence[State]) -> Array:
    """Returns the pose's covariance (3, 3) from those of both sights, taken as independent."""
    if len(states[0]) == 2:
        return NO_COVARIANCE
    blocks = np.zeros((4, 4))
    for k, (_, _, P11, P12, P22) in zip((0, 2), states, strict=True):
        blocks[k : k + 2, k : k + 2] = (P11, P12), (P12, P22)
    return surveyed_covariance(survey, blocks)[:3, :3]
