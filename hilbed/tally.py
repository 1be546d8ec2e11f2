"""What estimators, controllers and sensors count besides what they return, for verdict and report."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

ABOUT = {
    "ignored": "odometry and readings that could not be used: not finite, of another kind, out of their time",
    "singular": "bearings of a landmark on the robot's axis, which hardly tell its distance",
    "held": "bearings while the estimated distance of their landmark was at its least or largest",
    "restarted": "covariances that were not positive; that of the start took their place",
    "touching": "landmarks that the sensor stood on: in no direction, or with no gradient",
    "unexplained": "readings that gave every particle the weight zero and left the cloud as it was",
    "recovered": "clouds drawn anew after several of those",
    "effective": "effective sample size at the last reading",
    "beyond": "cycles with a heading error for which the law was not made",
    "limited": "cycles in which the robot's limits of speed and steering did not allow what was asked for",
    "saturated": "cycles in which the law asked for more than the controller may: max_speed, max_turn_rate",
    "standing": "cycles in which a steered robot was to turn without moving: the wheel turned and waited",
}
"""What the counters mean, by their names."""


@runtime_checkable
class Counting(Protocol):
    """A part that has something to say at the end of a run."""

    def counts(self) -> dict[str, float]:
        """Returns its counters, and other numbers, by name; NaN where there is none yet."""
        ...


def counts_of(part: object) -> dict[str, float]:
    """Returns what a part has counted; nothing where it does not count."""
    return part.counts() if isinstance(part, Counting) else {}
