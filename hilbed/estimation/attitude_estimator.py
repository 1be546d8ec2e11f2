"""The pose of a robot of which only positions are measured, by one of three attitude observers."""

from __future__ import annotations

from cmath import phase, rect
from collections.abc import Sequence

import numpy as np

from hilbed.angles import wrap
from hilbed.chords import chord
from hilbed.clock import nanos
from hilbed.estimation.attitude import STILL, Motion, extended, through
from hilbed.estimation.attitude_observers import OBSERVERS
from hilbed.estimation.attitude_spec import AttitudeSpec
from hilbed.estimation.dead_reckoning import extrapolation, usable
from hilbed.estimation.no_covariance import NO_COVARIANCE
from hilbed.estimation.readable import readable
from hilbed.estimation.ways import Waiting, Way, split
from hilbed.types import Estimate, Nanos, Odometry, Pose, Reading

SIZES = {"position": 2}
FRONT = {"front": 2}


class Attitude:
    """Positions as measured, carried by odometry in between; heading from the observer, at exposures.

    Takes "position" readings of the axle's midpoint; "front" ones of the same exposure are carried along with
    the turn for the controller, and tell the observer nothing. `ignored` counts what cannot be used: odometry
    and readings that are not finite, of another kind, out of order, older than the memory or as far ahead.
    """

    def __init__(self, spec: AttitudeSpec, start: Pose) -> None:
        self._observer = OBSERVERS[spec.form](start.yaw - spec.heading_error, spec.gain)
        self._memory = nanos(spec.memory)
        self._position = complex(start.x, start.y)
        self._seen: Nanos | None = None
        self._since: list[Way] = []  # the last exposure, or the start
        self._now = STILL
        self._t: Nanos = 0
        self._waiting = Waiting(self._memory)
        self._lever: complex | None = None  # from the position to the marker ahead, at the last exposure
        self.ignored = 0

    def counts(self) -> dict[str, float]:
        """Returns how much odometry and how many readings could not be used."""
        return {"ignored": self.ignored}

    def step(self, t: Nanos, odometry: Odometry, readings: Sequence[Reading]) -> Estimate:
        """Takes what has arrived by `t`; returns the belief at `t`, extrapolated beyond the odometry."""
        self._move(odometry)
        ready, refused = self._waiting.due(readings, self._t)
        self.ignored += refused
        for reading in sorted(ready, key=lambda reading: (reading.t, reading.kind == "front")):
            if reading.kind == "front":
                self._measure_front(reading)
            else:
                self._measure(reading)
        length, direction = chord(*extrapolation(t - self._t, odometry))
        ahead = self._now.displacement + rect(length, self._now.turn + direction)
        place = self._position + self._observer.heading * ahead
        turn = self._now.turn + 2.0 * direction
        mean = np.array((place.real, place.imag, wrap(phase(self._observer.heading) + turn)))
        if self._lever is None:
            return Estimate(t, mean, NO_COVARIANCE)
        front = place + self._lever * rect(1.0, turn)
        return Estimate(t, mean, NO_COVARIANCE, front=(front.real, front.imag))

    def _move(self, odometry: Odometry) -> None:
        if not usable(odometry) or odometry.t < self._t:
            self.ignored += 1
        elif odometry.t > self._t:
            way = Way(self._t, odometry.t, odometry.distance, odometry.turn)
            self._t = odometry.t
            self._since.append(way)
            self._now = extended(self._now, way)
            if self._since[0].end < way.end - self._memory:
                self._carry(self._since.pop(0))

    def _carry(self, way: Way) -> None:
        """Moves the kept state over a way too old to be measured in."""
        motion = extended(STILL, way)
        self._position += self._observer.heading * motion.displacement
        self._observer.step(motion._replace(displacement=0j))
        self._turn_lever(motion)
        self._seen = None
        self._now = through(self._since)

    def _measure(self, reading: Reading) -> None:
        """Corrects the heading at the exposure by the way since the last one."""
        fresh = self._seen is None or reading.t > self._seen
        known = not self._since or reading.t >= self._since[0].start
        if not (readable(reading, SIZES) and fresh and known):
            self.ignored += 1
            return
        place = complex(*reading.value)
        before, after = split(self._since, reading.t)
        motion = through(before)
        if self._seen is None:  # nothing to compare with: only the turn
            motion = motion._replace(displacement=0j)
        self._observer.step(motion._replace(measured=place - self._position))
        self._turn_lever(motion)
        self._position, self._seen, self._since = place, reading.t, after
        self._now = through(after)

    def _measure_front(self, reading: Reading) -> None:
        """Takes the marker ahead, which is only of use beside the position of the same exposure."""
        if readable(reading, FRONT) and reading.t == self._seen:
            self._lever = complex(*reading.value) - self._position
        else:
            self.ignored += 1

    def _turn_lever(self, motion: Motion) -> None:
        if self._lever is not None:
            self._lever *= rect(1.0, motion.turn)
