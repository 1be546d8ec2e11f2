"""Which part of a recorded robot's file a run plays, and what is in it."""

from __future__ import annotations

from bisect import bisect_right
from math import inf, nan, remainder, sqrt, tau

import numpy as np
import numpy.typing as npt

from hilbed.angles import wrap
from hilbed.clock import nanos, seconds
from hilbed.plant.recorded_spec import RecordedSpec
from hilbed.plant.recording import Recording
from hilbed.spec import Point
from hilbed.types import Array, Nanos, Pose, ScenarioError

Rows = npt.NDArray[np.intp]

ROUNDING = 1e-9  # s: times in files are decimal
VARIANCES = {"azimuth": "bearing_variance", "range": "range_variance"}
UNKNOWN = Pose(nan, nan, nan)


class Recorded:
    """The part of a recording that a run plays, valid once constructed; t = 0 is its first row.

    Raises ScenarioError where the part is empty, lacks what is asked for, or starts at an unknown pose.
    """

    def __init__(self, spec: RecordedSpec, recording: Recording) -> None:
        stop = inf if spec.length is None else spec.start + spec.length
        rows = np.flatnonzero((recording.t >= spec.start - ROUNDING) & (recording.t <= stop + ROUNDING))
        problems = _problems(spec, recording, rows)
        if problems:
            raise ScenarioError("\n".join(f"{spec.file}: {problem}" for problem in problems))
        self._spec, self._recording = spec, recording
        self._part = part = slice(rows[0], rows[-1] + 1)
        self.mount, self.anonymous = recording.mount, spec.anonymous
        self.beacons: list[Point] = [(x, y) for x, y in recording.landmarks.tolist()]
        self.times: list[Nanos] = [nanos(t) for t in (recording.t[part] - recording.t[rows[0]]).tolist()]
        self.v: list[float] = recording.v[part].tolist()
        self.w: list[float] = recording.omega[part].tolist()
        self.poses = [Pose(*row) for row in recording.truth[part].tolist()]
        self.start = Pose(*spec.pose) if spec.pose else self.poses[0]

    @property
    def duration(self) -> float:
        """How long the part lasts (s)."""
        return seconds(self.times[-1])

    def row(self, t: Nanos) -> int:
        """Returns the last row at or before `t`, −1 before the first."""
        return bisect_right(self.times, t) - 1

    def truth(self, t: Nanos) -> Pose:
        """Returns the true pose at `t`, between rows on the straight line; NaN where it is not known."""
        row = self.row(t)
        if row < 0 or t > self.times[-1]:
            return UNKNOWN
        if self.times[row] == t:
            return self.poses[row]
        share = (t - self.times[row]) / (self.times[row + 1] - self.times[row])
        return _between(self.poses[row], self.poses[row + 1], share)

    def seen(self, kind: str) -> Array:
        """Returns the readings (rows, beacons) of a kind, NaN where there is none."""
        column = self._recording.bearing if kind == "azimuth" else self._recording.range
        if column is None:
            raise ScenarioError(f"{self._spec.file}: there is no {kind} in this file")
        seen = column[self._part]
        far = self._recording.range
        if self._spec.max_range is None or far is None:
            return seen
        return np.where(far[self._part] <= self._spec.max_range, seen, np.nan)

    def std(self, kind: str) -> float:
        """Returns what readings of a kind say of themselves (rad or m)."""
        told = self._spec.azimuth_std if kind == "azimuth" else self._spec.range_std
        return told or sqrt(self._recording.variances[VARIANCES[kind]])


def _problems(spec: RecordedSpec, recording: Recording, rows: Rows) -> list[str]:
    problems = []
    if len(rows) < 2:
        problems.append(f"start = {spec.start:g} s leaves nothing of a file of {recording.t[-1]:g} s")
    elif spec.pose is None and not np.isfinite(recording.truth[rows[0]]).all():
        problems.append("the true pose at the start is not known; give `pose`, or another `start`")
    for kind in spec.kinds():
        key, told = ("bearing", spec.azimuth_std) if kind == "azimuth" else ("range", spec.range_std)
        if (recording.bearing if kind == "azimuth" else recording.range) is None:
            problems.append(f"there is no {key} in this file; set {kind}: false")
        elif told is None and VARIANCES[kind] not in recording.variances:
            problems.append(f"there is no {VARIANCES[kind]} in this file; give {kind}_std")
    return problems


def _between(a: Pose, b: Pose, share: float) -> Pose:
    yaw = a.yaw + share * remainder(b.yaw - a.yaw, tau)
    return Pose(a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), wrap(yaw))
