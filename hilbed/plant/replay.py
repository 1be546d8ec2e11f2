"""A recorded robot in place of a plant: odometry, readings and truth come from a file at their own times."""

from __future__ import annotations

from math import atan2, cos, hypot, isnan, sin

from hilbed.angles import wrap
from hilbed.clock import NEVER, seconds
from hilbed.plant.recorded import Recorded
from hilbed.ports import Witness
from hilbed.spec import Point
from hilbed.types import Command, Nanos, Odometry, Pose, Reading, Truth


class RecordedBase:
    """Odometry of the file; commands go nowhere."""

    def __init__(self, recorded: Recorded) -> None:
        self._recorded = recorded
        self._row = 0

    def read(self, t: Nanos) -> Odometry:
        """Returns the way of all rows since the last reading, each speed held to the next row's time."""
        played, last = self._recorded, max(self._recorded.row(t), self._row)
        distance = turn = 0.0
        for row in range(self._row, last):
            step = seconds(played.times[row + 1] - played.times[row])
            distance += played.v[row] * step
            turn += played.w[row] * step
        self._row = last
        return Odometry(played.times[last], distance, turn, played.v[last], played.w[last])

    def write(self, t: Nanos, command: Command) -> None:
        """Ignores the command: what the robot did has happened."""


class RecordedPlant:
    """The file's truth, moved along by the clock."""

    def __init__(self, recorded: Recorded) -> None:
        self._recorded = recorded
        self._t: Nanos = 0

    def truth(self) -> Truth:
        """Returns the true pose now; NaN where the file does not know it."""
        return Truth(self._t, self._recorded.truth(self._t))

    def advance(self, start: Nanos, end: Nanos) -> None:  # noqa: ARG002
        """Moves to `end`."""
        self._t = end


class RecordedSensor:
    """Readings of one kind, delivered at their own times; true values, from the true pose, to the witness."""

    due: Nanos = NEVER  # there is no world to be sampled

    def __init__(self, recorded: Recorded, kind: str, witness: Witness) -> None:
        self._recorded = recorded
        self._kind = kind
        self._witness = witness
        self._std = (recorded.std(kind),)
        self._seen = [_present(row) for row in recorded.seen(kind).tolist()]
        self._row = -1

    def sample(self, truth: Truth) -> None:
        """Does nothing."""

    def read(self, t: Nanos) -> list[Reading]:
        """Returns the readings of all rows since the last call, up to `t`."""
        first, self._row = self._row + 1, max(self._recorded.row(t), self._row)
        return [
            self._reading(row, beacon, value)
            for row in range(first, self._row + 1)
            for beacon, value in self._seen[row]
        ]

    def _reading(self, row: int, beacon: int, value: float) -> Reading:
        played, azimuth = self._recorded, self._kind == "azimuth"
        t, told = played.times[row], None if played.anonymous else beacon
        reading = Reading(self._kind, t, t, (wrap(value) if azimuth else value,), self._std, told)
        bearing, length = sight(played.poses[row], played.beacons[beacon], played.mount)
        self._witness.reading(reading, beacon, (bearing if azimuth else length,))
        return reading


def _present(row: list[float]) -> list[tuple[int, float]]:
    return [(beacon, value) for beacon, value in enumerate(row) if not isnan(value)]


def sight(pose: Pose, beacon: Point, mount: Point) -> tuple[float, float]:
    """Returns azimuth (rad, robot's frame) and range (m) of a beacon from a sensor at `mount` (m)."""
    c, s = cos(pose.yaw), sin(pose.yaw)
    dx = beacon[0] - pose.x - (c * mount[0] - s * mount[1])
    dy = beacon[1] - pose.y - (s * mount[0] + c * mount[1])
    return wrap(atan2(dy, dx) - pose.yaw), hypot(dx, dy)
