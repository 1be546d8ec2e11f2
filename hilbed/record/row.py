"""What every record is made from: one control period with the poses that only the recorder works out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import cos, nan, sin
from typing import NamedTuple, Protocol

from hilbed.angles import wrap
from hilbed.types import Array, Cycle, Nanos, Odometry, Pose, Reading, Snapshot, Transfer

UNKNOWN = Pose(nan, nan, nan)


class Witnessed(NamedTuple):
    """A reading with the truth behind it: beacon −1 and true NaN where it is spurious."""

    reading: Reading
    beacon: int
    true: tuple[float, ...]


class Row(NamedTuple):
    """A control period, where dead reckoning puts the robot and where the reference wants it."""

    cycle: Cycle
    odometry: Pose
    reference: Pose


class Batch(NamedTuple):
    """All that has happened since the previous batch; the lists belong to the journal and are reused.

    ticks: new rows of the plant's log by name, "tick/t" (n,) and "tick/drive/NAME/…" (n,).
    """

    row: Row | None
    transfers: Sequence[Transfer]
    readings: Sequence[Witnessed]
    snapshots: Sequence[Snapshot]
    ticks: Mapping[str, Array]


class Sink(Protocol):
    """Where batches go: signals, a log file, a hash."""

    def take(self, batch: Batch) -> None:
        """Records a batch; raises RecordError if it cannot be written."""
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


def moved(pose: Pose, distance: float, turn: float) -> Pose:
    """Moves a pose by an arc of `distance` (m) that turns it by `turn` (rad); second order in the turn."""
    middle = pose.yaw + 0.5 * turn
    x, y = pose.x + distance * cos(middle), pose.y + distance * sin(middle)
    return Pose(x, y, wrap(pose.yaw + turn))
