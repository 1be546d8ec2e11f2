"""How far apart truth, estimate, odometry and reference are."""

from __future__ import annotations

from math import inf

import numpy as np

from hilbed.criteria.signals import Column, Signals


def estimate_position_rms(signals: Signals) -> float:
    """Distance between estimate and truth, root mean square."""
    return rms(distance(signals, "estimate"))


def estimate_position_max(signals: Signals) -> float:
    """Distance between estimate and truth, largest."""
    return largest(distance(signals, "estimate"))


def estimate_position_final(signals: Signals) -> float:
    """Distance between estimate and truth, at the end."""
    return last(distance(signals, "estimate"))


def estimate_yaw_rms(signals: Signals) -> float:
    """Difference in yaw between estimate and truth, root mean square."""
    return rms(turned(signals, "estimate"))


def estimate_yaw_final(signals: Signals) -> float:
    """Difference in yaw between estimate and truth, at the end."""
    return last(np.abs(turned(signals, "estimate")))


def odometry_position_rms(signals: Signals) -> float:
    """Distance between dead reckoning and truth, root mean square."""
    return rms(distance(signals, "odometry"))


def odometry_position_final(signals: Signals) -> float:
    """Distance between dead reckoning and truth, at the end."""
    return last(distance(signals, "odometry"))


def odometry_yaw_rms(signals: Signals) -> float:
    """Difference in yaw between dead reckoning and truth, root mean square."""
    return rms(turned(signals, "odometry"))


def odometry_over_estimate(signals: Signals) -> float:
    """How many times larger odometry_position_rms is than estimate_position_rms."""
    estimated = estimate_position_rms(signals)
    return odometry_position_rms(signals) / estimated if estimated else inf


def reference_distance_rms(signals: Signals) -> float:
    """Distance between truth and reference at the same time, root mean square."""
    return rms(distance(signals, "reference"))


def reference_distance_max(signals: Signals) -> float:
    """Distance between truth and reference at the same time, largest."""
    return largest(distance(signals, "reference"))


def reference_distance_final(signals: Signals) -> float:
    """Distance between truth and reference, at the end."""
    return last(distance(signals, "reference"))


def reference_yaw_rms(signals: Signals) -> float:
    """Difference in yaw between truth and reference, root mean square."""
    return rms(turned(signals, "reference"))


def reference_yaw_max(signals: Signals) -> float:
    """Difference in yaw between truth and reference, largest."""
    return largest(np.abs(turned(signals, "reference")))


def reference_yaw_final(signals: Signals) -> float:
    """Difference in yaw between truth and reference, at the end."""
    return last(np.abs(turned(signals, "reference")))


def turning_radius(signals: Signals) -> float:
    """Length of the way over its turn, each cycle's way taken for an arc."""
    truth = signals["truth"]
    turn = wrapped(np.diff(truth[:, 2]))
    chords = np.hypot(*np.diff(truth[:, :2], axis=0).T)
    total = float(np.abs(turn).sum())
    return float((chords / np.sinc(turn / (2 * np.pi))).sum()) / total if total else inf


def landmark_distance_error_max(signals: Signals) -> float:
    """Estimated minus true distance of the first two beacons, largest magnitude."""
    estimated = signals["landmark_distance"]
    first, second = signals["beacons"][:2]
    return largest(np.abs(estimated - np.hypot(*(second - first))))


def cross_track_rms(signals: Signals) -> float:
    """Distance of truth from the tangent of the path at the reference, root mean square."""
    return rms(cross_track(signals))


def cross_track_max(signals: Signals) -> float:
    """Distance of truth from the tangent of the path at the reference, largest."""
    return largest(np.abs(cross_track(signals)))


def distance(signals: Signals, name: str) -> Column:
    """Returns the distance (N,) in m between truth and another pose."""
    difference = signals[name][:, :2] - signals["truth"][:, :2]
    return np.asarray(np.hypot(difference[:, 0], difference[:, 1]))


def turned(signals: Signals, name: str) -> Column:
    """Returns the yaw (N,) in rad, in (−π, π], of another pose minus that of truth."""
    return wrapped(signals[name][:, 2] - signals["truth"][:, 2])


def cross_track(signals: Signals) -> Column:
    """Returns how far (N,) in m truth lies to the left of the reference, in the reference's frame."""
    x, y = (signals["truth"][:, :2] - signals["reference"][:, :2]).T
    yaw = signals["reference"][:, 2]
    return np.asarray(np.cos(yaw) * y - np.sin(yaw) * x)


def wrapped(angle: Column) -> Column:
    """Returns angles (rad) in (−π, π]."""
    return np.pi - np.remainder(np.pi - angle, 2 * np.pi)


def rms(values: Column) -> float:
    """Returns the root mean square of what is known; NaN where nothing is."""
    known = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(known * known))) if len(known) else float("nan")


def largest(values: Column) -> float:
    """Returns the largest of what is known; NaN where nothing is."""
    known = values[np.isfinite(values)]
    return float(known.max()) if len(known) else float("nan")


def last(values: Column) -> float:
    """Returns the last value; NaN where there is none."""
    return float(values[-1]) if len(values) else float("nan")
