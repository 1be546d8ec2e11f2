"""Errors of odometer and sensor that explain a run whose truth is known."""

from __future__ import annotations

from math import atan2, ceil, cos, sin, tau
from typing import NamedTuple

import numpy as np

from hilbed.estimation.measurement import Point
from hilbed.estimation.odometry_model import OdometryModel
from hilbed.types import Array

LEAST = 1e-3  # m/√m, rad/√m, rad/√rad: no odometer is better, and a filter must not believe so
SHARPEST = 1e-5  # rad or m: the same for a sensor
LATEST = 0.3  # s: delays are looked for within ± this


def wrapped(angle: Array) -> Array:
    """Returns angles (rad) in [−π, π)."""
    return np.mod(np.add(angle, np.pi), 2 * np.pi) - np.pi


def increments(poses: Array) -> Array:
    """Returns forward, left (m) and turn (rad) between poses (N, 3), in the frame half-way: (N − 1, 3).

    Forward is the way along the arc, of which the poses show the chord.
    """
    turn = wrapped(np.diff(poses[:, 2]))
    a = poses[:-1, 2] + turn / 2
    dx, dy = (np.diff(poses[:, axis]) / np.sinc(turn / tau) for axis in (0, 1))
    return np.column_stack((dx * np.cos(a) + dy * np.sin(a), dy * np.cos(a) - dx * np.sin(a), turn))


def fit_odometry(truth: Array, odometry: Array, rows: int) -> OdometryModel:
    """Returns the odometer's errors from true and dead-reckoned poses (N, 3), NaN where unknown.

    Direction and scales are least squares, noise the variance left, all over windows of `rows` rows: in
    single rows the noise of the truth itself would dominate. Heading noise is shared out between way and
    turn by non-negative least squares.
    """
    from scipy.optimize import nnls

    true, told = increments(truth), increments(odometry)
    ahead = np.sign(told[:, 0])[:, None]
    forward, left, _ = np.nansum(ahead * true, axis=0)
    direction = atan2(left, forward)
    along = true[:, 0] * cos(direction) + true[:, 1] * sin(direction)
    sums = _windows(np.column_stack((along, told[:, 0], true[:, 2], told[:, 2], np.abs(told[:, ::2]))), rows)
    way, told_way, turn, told_turn, length, angle = sums.T
    distance_scale, turn_scale = _slope(told_way, way), _slope(told_turn, turn)
    slip = np.square(way - distance_scale * told_way)
    swing = np.square(turn - turn_scale * told_turn)
    by_way, by_turn = nnls(np.column_stack((length, angle)), swing)[0]
    noise = np.sqrt((slip.sum() / max(length.sum(), LEAST), by_way, by_turn))
    return OdometryModel(direction, distance_scale, turn_scale, *np.maximum(noise, LEAST).tolist())


def _windows(columns: Array, rows: int) -> Array:
    """Sums of `rows` rows each; windows that hold NaN are left out."""
    count = len(columns) // rows
    sums: Array = columns[: count * rows].reshape(count, rows, -1).sum(axis=1)
    return sums[np.isfinite(sums).all(axis=1)]


def _slope(told: Array, true: Array) -> float:
    """Returns true over told by least squares, 1 where hardly anything was told."""
    return float(told @ true / (told @ told)) if told @ told > LEAST else 1.0


class Sightings(NamedTuple):
    """Readings of one kind: exposure t (K,) s, place of the beacon (K, 2) m, measured (K,) rad or m."""

    t: Array
    beacon: Array
    measured: Array


class SensorFit(NamedTuple):
    """Delay (s), mount (m), and by kind: bias, std, beacon_std and how many readings told so."""

    delay: float
    mount: Point
    kinds: dict[str, tuple[float, float, float, int]]


class Track(NamedTuple):
    """Where the robot truly was: t (N,) s, poses (N, 3) with the yaw unwrapped, without gaps."""

    t: Array
    poses: Array


def track(t: Array, truth: Array) -> Track:
    """Returns the known rows of a truth (N, 3)."""
    known = np.isfinite(truth).all(axis=1)
    poses = truth[known].copy()
    poses[:, 2] = np.unwrap(poses[:, 2])
    return Track(t[known], poses)


def witnessed(seen: Sightings, t: Array, truth: Array) -> Sightings:
    """Returns the sightings around whose time (± LATEST) the truth (N, 3) is known."""
    margin = ceil(LATEST / float(np.median(np.diff(t)))) + 1
    unknown = ~np.isfinite(truth).all(axis=1)
    near = np.convolve(unknown, np.ones(2 * margin + 1), "same") > 0
    keep = np.interp(seen.t, t, near.astype(float)) == 0
    keep &= (seen.t > t[0] + LATEST) & (seen.t < t[-1] - LATEST)
    return Sightings(seen.t[keep], seen.beacon[keep], seen.measured[keep])


def fit_sensor(truth: Track, sightings: dict[str, Sightings]) -> SensorFit:
    """Returns what best explains azimuths and ranges taken by one sensor.

    Least squares over delay, mount and one bias a kind, with soft-L1 loss, so that outliers pull little;
    then the scatter: variance = std² + (beacon_std / range)² for azimuths, std² for ranges.
    """
    from scipy.optimize import least_squares

    kinds = list(sightings)
    scale = {"azimuth": 0.02, "range": 0.02}

    def errors(p: Array) -> Array:
        parts = [
            _residuals(kind, seen, truth, p[:3])[0] - p[3 + k]
            for k, (kind, seen) in enumerate(sightings.items())
        ]
        return np.concatenate([e / scale[kind] for e, kind in zip(parts, kinds, strict=True)])

    limit = [LATEST, 5.0, 5.0] + [1.0] * len(kinds)
    best = least_squares(errors, np.zeros(len(limit)), bounds=([-b for b in limit], limit), loss="soft_l1").x
    fitted = {}
    for k, (kind, seen) in enumerate(sightings.items()):
        error, distance = _residuals(kind, seen, truth, best[:3])
        fitted[kind] = (float(best[3 + k]), *_scatter(kind, error - best[3 + k], distance), len(error))
    return SensorFit(float(best[0]), (float(best[1]), float(best[2])), fitted)


def _residuals(kind: str, seen: Sightings, truth: Track, p: Array) -> tuple[Array, Array]:
    """Returns measured − expected, and the range, for delay and mount p = (s, m, m)."""
    delay, ahead, left = p
    x, y, yaw = (np.interp(seen.t - delay, truth.t, column) for column in truth.poses.T)
    dx = seen.beacon[:, 0] - x - (np.cos(yaw) * ahead - np.sin(yaw) * left)
    dy = seen.beacon[:, 1] - y - (np.sin(yaw) * ahead + np.cos(yaw) * left)
    distance: Array = np.hypot(dx, dy)
    if kind == "range":
        return seen.measured - distance, distance
    return wrapped(seen.measured - (np.arctan2(dy, dx) - yaw)), distance


def _scatter(kind: str, error: Array, distance: Array) -> tuple[float, float]:
    """Returns std and beacon_std; squared errors beyond 9 times their median count as that (spurious)."""
    from scipy.optimize import nnls

    squared = np.minimum(np.square(error), 9 * np.median(np.square(error)) / 0.4549)
    if kind == "range":
        return max(float(np.sqrt(squared.mean())), SHARPEST), 0.0
    base, near = nnls(np.column_stack((np.ones_like(distance), distance**-2.0)), squared)[0]
    return max(float(np.sqrt(base)), SHARPEST), float(np.sqrt(near))
