"""What every record is made from: one control period with the poses that only the recorder works out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import nan
from typing import NamedTuple, Protocol

from hilbed.poses import moved
from hilbed.types import (
    Array,
    Cycle,
    DriveSignals,
    Innovation,
    Nanos,
    Odometry,
    Pose,
    Reading,
    Snapshot,
    Transfer,
)

UNKNOWN = Pose(nan, nan, nan)


class Witnessed(NamedTuple):
    """A reading with the truth behind it: beacon −1 and true NaN where it is spurious."""

    reading: Reading
    beacon: int
    true: tuple[float, ...]


class Row(NamedTuple):
    """A control period and its numbers, worked out once for all sinks.

    numbers: truth, odometry by dead reckoning, reference (3 each), command (2), estimate (3), covariance (9),
    landmark distance; of the odometry: when it was sampled (s), distance, turn, v, w (5). drives: by name, as
    the controller sees them; innovations, cloud: those of the estimate.
    """

    t: Nanos
    numbers: list[float]
    drives: Mapping[str, DriveSignals]
    innovations: Sequence[Innovation]
    cloud: Array | None = None


WIDTH = 29  # numbers a row


def row_of(cycle: Cycle, odometry: Pose, reference: Pose) -> Row:
    """Returns the row of a cycle with the poses that only the recorder works out."""
    estimate = cycle.estimate
    numbers = [*cycle.truth.pose, *odometry, *reference, *cycle.command, *estimate.mean.tolist()[:3]]
    for line in estimate.covariance.tolist()[:3]:
        numbers += line[:3]
    numbers.append(estimate.landmark_distance)
    sampled, distance, turn, v, w, drives = cycle.odometry
    numbers += (sampled * 1e-9, distance, turn, v, w)
    return Row(cycle.t, numbers, drives, estimate.innovations, estimate.cloud)


class Batch(NamedTuple):
    """All that has happened since the previous batch; the lists are emptied once the sinks have taken it.

    ticks: new rows of the plant's log, each by name: "tick/t" (n,) and "tick/drive/NAME/…" (n,).
    """

    rows: Sequence[Row]
    transfers: Sequence[Transfer]
    readings: Sequence[Witnessed]
    snapshots: Sequence[Snapshot]
    ticks: Sequence[Mapping[str, Array]]


class Sink(Protocol):
    """Where batches go: signals, a log file, a hash."""

    def take(self, batch: Batch) -> None:
        """Records a batch, to the disk if anywhere; raises RecordError if it cannot be written."""
        ...

    def close(self) -> None: ...


class DeadReckoning:
    """Pose from wheel odometry alone: arcs are added at the yaw of their middle."""

    __slots__ = ("_pose",)

    def __init__(self, start: Pose) -> None:
        self._pose = start

    def at(self, t: Nanos, odometry: Odometry) -> Pose:
        """Adds the odometry's step and returns the pose carried on to `t` with its speeds.

        The counts are older than `t`, by the sampling of the drives and the way over the bus.
        """
        self._pose = moved(self._pose, odometry.distance, odometry.turn)
        late = (t - odometry.t) * 1e-9
        return moved(self._pose, odometry.v * late, odometry.w * late)
