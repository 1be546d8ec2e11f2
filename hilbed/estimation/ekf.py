"""Extended Kalman filter of the pose from odometry, azimuths and ranges, each taken at its own time."""

from __future__ import annotations

from collections.abc import Sequence
from math import nan, pi

import numpy as np

from hilbed.clock import nanos
from hilbed.estimation.association import nearest
from hilbed.estimation.dead_reckoning import extrapolation, usable
from hilbed.estimation.filter import PoseFilter
from hilbed.estimation.measurement import MODELS, Point
from hilbed.estimation.motion import predicted
from hilbed.estimation.readable import readable
from hilbed.estimation.specs import EkfSpec
from hilbed.estimation.timeline import Measurement, Node, Timeline
from hilbed.types import Estimate, Innovation, Nanos, Odometry, Pose, Reading

SIZES = {"azimuth": 1, "range": 1}
WIDEST = pi**2  # rad²: with no idea of the yaw, more inflation would say nothing


class Ekf:
    """Localises a robot among known beacons.

    A late reading rewinds the filter to its exposure and replays what came after, so the result is that
    of processing in order. `ignored` counts odometry and readings that cannot be used: not finite, of an
    unknown kind or beacon, with a standard deviation that is not positive, or older than the memory;
    `touching` readings of a beacon that the sensor is believed to stand on; `restarted` how often round-off
    left a covariance that is not positive, and that of the start took its place. What late readings make the
    filter go over again counts again.
    """

    def __init__(
        self, spec: EkfSpec, beacons: Sequence[Point], start: Pose, mount: Point = (0.0, 0.0)
    ) -> None:
        """start: pose at t = 0; beacons (m, map); mount (m): the sensor's, used where the spec gives none."""
        self._spec = spec
        self._kinds = {"azimuth": spec.azimuth, "range": spec.range}
        self._odometry = spec.odometry.model()
        self._beacons = [(float(x), float(y)) for x, y in beacons]
        self._mount = spec.mount or mount
        self._delay = nanos(spec.delay)
        self._gate = spec.gate**2 if spec.gate else float("inf")
        mean, covariance = np.array(start, dtype=float), np.diag(np.square(spec.initial_std))
        self._filter = PoseFilter(mean, covariance)
        self._memory = nanos(spec.memory)
        self._timeline = Timeline(Node(-1, mean, covariance), self._memory)  # an exposure at 0 comes after it
        self._waiting: list[Measurement] = []
        self._unknowing = covariance
        self.ignored = self.touching = self.restarted = 0

    def counts(self) -> dict[str, float]:
        """Returns how much could not be used, and what befell the filter."""
        return {"ignored": self.ignored, "touching": self.touching, "restarted": self.restarted}

    def step(self, t: Nanos, odometry: Odometry, readings: Sequence[Reading]) -> Estimate:
        """Takes what has arrived by `t`; returns the belief at `t`, extrapolated beyond the odometry."""
        fresh = self._admit(readings)
        moved = self._move(odometry)
        self._replay(self._timeline, min(moved, self._place(fresh)))
        now = self._at(t, odometry)
        innovations = tuple(m.innovation for m in fresh if m.innovation is not None)
        return Estimate(t, now.mean.copy(), now.covariance.copy(), innovations)

    def _admit(self, readings: Sequence[Reading]) -> list[Measurement]:
        """Makes usable readings ready and counts the others."""
        measurements = []
        for reading in readings:
            if not self._usable(reading):
                self.ignored += 1
            elif (kind := self._kinds[reading.kind]).use:
                variance = (kind.std or reading.std[0]) ** 2
                value = reading.value[0] - kind.bias
                measurements.append(Measurement(reading.t - self._delay, reading, value, variance))
        return measurements

    def _usable(self, reading: Reading) -> bool:
        known = reading.beacon is None or 0 <= reading.beacon < len(self._beacons)
        return known and readable(reading, SIZES)

    def _move(self, odometry: Odometry) -> int:
        """Appends an increment; returns the index of the first node to be run."""
        if not usable(odometry):
            self.ignored += 1
        elif odometry.t > self._timeline.last.t:
            self._timeline.extend(odometry.t, odometry.distance, odometry.turn)
            return len(self._timeline.nodes) - 1
        elif odometry.distance or odometry.turn:
            self.ignored += 1  # a way without time: the stamp is wrong
        return len(self._timeline.nodes)

    def _place(self, fresh: list[Measurement]) -> int:
        """Puts measurements up to the last node on the timeline; returns the index of the earliest."""
        timeline, ready = self._timeline, self._waiting + fresh
        self._waiting, first = [], len(timeline.nodes)
        for measurement in ready:
            if not timeline.oldest < measurement.t < timeline.last.t + self._memory:
                self.ignored += 1
            elif measurement.t > timeline.last.t:
                self._waiting.append(measurement)
            else:
                first = min(first, timeline.insert(measurement))
        return first

    def _at(self, t: Nanos, odometry: Odometry) -> Node:
        """Returns the belief at `t`, exposures after the last odometry included, without keeping it."""
        last = self._timeline.last
        if t <= last.t:
            return last
        step = extrapolation(t - last.t, odometry)
        early = [measurement for measurement in self._waiting if measurement.t <= t]
        if not early:
            return Node(t, *predicted(last.mean, last.covariance, step, self._odometry))
        ahead = Timeline(last, self._memory)
        ahead.extend(t, *step)
        for measurement in early:
            ahead.insert(measurement)
        self._replay(ahead, 1)
        return ahead.last

    def _replay(self, timeline: Timeline, first: int) -> None:
        """Runs the filter over the nodes from `first` on: the way to each, then what was measured there."""
        nodes, belief = timeline.nodes, self._filter
        for before, node in zip(nodes[first - 1 :], nodes[first:], strict=False):
            belief.load(before.mean, before.covariance)
            belief.move(node.distance, node.turn, self._odometry)
            node.refused = before.refused
            for measurement, beacon in self._assigned(node.measurements):
                node.refused = self._fuse(measurement, beacon, node.refused)
            node.mean, node.covariance = belief.x, belief.P

    def _assigned(self, measurements: list[Measurement]) -> list[tuple[Measurement, int | None]]:
        """Pairs measurements of one moment with beacons: as told, else the nearest at the prior."""
        pairs: list[tuple[Measurement, int | None]]
        pairs = [(m, m.reading.beacon) for m in measurements if m.reading.beacon is not None]
        for kind in MODELS if len(pairs) < len(measurements) else ():
            nameless = [m for m in measurements if m.reading.beacon is None and m.reading.kind == kind]
            taken = [beacon for m, beacon in pairs if m.reading.kind == kind and beacon is not None]
            squared = self._squared(kind, nameless)
            pairs += zip(nameless, nearest(squared, taken), strict=True)
        return pairs

    def _squared(self, kind: str, measurements: list[Measurement]) -> list[list[float]]:
        """Returns v²/S of each measurement (row) of one kind and each beacon (column)."""
        model, belief = MODELS[kind], self._filter
        expected = [model.predict(belief.x, beacon, self._mount) for beacon in self._beacons]
        spread = [belief.spread(e) for e in expected]
        return [
            [
                model.difference(m.value, e.value) ** 2 / (s + self._noise(m, e.per_metre))
                for e, s in zip(expected, spread, strict=True)
            ]
            for m in measurements
        ]

    def _noise(self, measurement: Measurement, per_metre: float) -> float:
        """Returns R: the sensor's variance, and that of the beacon's place as the sensor sees it."""
        doubt = self._kinds[measurement.reading.kind].beacon_std * per_metre
        return measurement.variance + doubt * doubt

    def _fuse(self, measurement: Measurement, beacon: int | None, refused: int) -> int:
        """Updates by one measurement if the gate lets it; returns how many were refused in a row."""
        reading, belief = measurement.reading, self._filter
        if beacon is None:  # more readings than beacons
            measurement.innovation = Innovation(reading.t, nan, 1, False)
            return refused
        model = MODELS[reading.kind]
        expected = model.predict(belief.x, self._beacons[beacon], self._mount)
        noise = self._noise(measurement, expected.per_metre)
        v = model.difference(measurement.value, expected.value)
        nis = v * v / (belief.spread(expected) + noise)
        self.touching += expected.touching
        measurement.innovation = Innovation(reading.t, nis, 1, nis <= self._gate)
        if nis > self._gate:
            return self._refuse(refused + 1)
        belief.correct(v, noise, expected)
        if not belief.positive:
            belief.P = self._unknowing
            self.restarted += 1
        return 0

    def _refuse(self, refused: int) -> int:
        """Widens the belief after too many refusals in a row, so that the gate cannot lock it out."""
        inflation = self._spec.inflation
        if inflation is None or refused < inflation.after or self._filter.P[2, 2] > WIDEST:
            return refused
        self._filter.P = inflation.factor * self._filter.P
        return 0
