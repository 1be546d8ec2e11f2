"""An ideal experiment: a robot on a circle that slips as told, azimuths and ranges with white noise."""

from __future__ import annotations

from math import atan2, cos, hypot, sin
from typing import NamedTuple

import numpy as np

from hilbed.angles import wrap
from hilbed.types import Odometry, Pose, Reading

BEACONS = [(4.0, 0.5), (-1.0, 4.0), (-4.0, -1.0), (1.5, -3.5)]
PERIOD = 50_000_000
START = Pose(2.0, 0.0, 1.5)


class Errors(NamedTuple):
    """What is wrong with odometer and sensor: as in OdometryModel and EkfSpec; latency in ns."""

    direction: float = 0.0
    distance_scale: float = 1.0
    turn_scale: float = 1.0
    distance_noise: float = 0.02
    heading_noise: float = 0.05
    turn_noise: float = 0.02
    mount: tuple[float, float] = (0.0, 0.0)
    delay: float = 0.0
    azimuth_std: float = 0.01
    azimuth_bias: float = 0.0
    range_std: float = 0.02
    range_bias: float = 0.0


IDEAL = Errors()


class Step(NamedTuple):
    t: int
    truth: Pose
    odometry: Odometry
    readings: list[Reading]


def exact_arc(pose: Pose, way: float, turn: float, direction: float) -> Pose:
    """An exact arc, written on its own: chord 2R sin(turn/2)."""
    chord = way if abs(turn) < 1e-12 else 2 * way / turn * sin(turn / 2)
    a = pose.yaw + turn / 2 + direction
    return Pose(pose.x + chord * cos(a), pose.y + chord * sin(a), wrap(pose.yaw + turn))


def sight(pose: Pose, beacon: tuple[float, float], mount: tuple[float, float]) -> tuple[float, float]:
    c, s = cos(pose.yaw), sin(pose.yaw)
    dx = beacon[0] - (pose.x + c * mount[0] - s * mount[1])
    dy = beacon[1] - (pose.y + s * mount[0] + c * mount[1])
    return wrap(atan2(dy, dx) - pose.yaw), hypot(dx, dy)


def experiment(
    seed: int, steps: int, errors: Errors = IDEAL, kinds: tuple[str, ...] = ("azimuth",)
) -> list[Step]:
    """Drives about 0.5 m/s on a wavy path; readings every fourth step, stamped late by errors.delay."""
    rng = np.random.default_rng(seed)
    pose, history, rows = START, [START], []
    for k in range(steps):
        t = k * PERIOD
        way, turn = (0.0, 0.0) if k == 0 else (0.025, 0.0125 + 0.02 * sin(0.05 * k))
        slip = rng.normal(0, errors.distance_noise * abs(way) ** 0.5)
        swing = (
            rng.normal(0, 1) * (errors.heading_noise**2 * abs(way) + errors.turn_noise**2 * abs(turn)) ** 0.5
        )
        pose = exact_arc(
            pose, way * errors.distance_scale + slip, turn * errors.turn_scale + swing, errors.direction
        )
        history.append(pose)
        behind = round(errors.delay * 1e9 / PERIOD)
        seen = history[max(len(history) - 1 - behind, 0)]
        odometry = Odometry(t, way, turn, way / 0.05, turn / 0.05)
        readings = _readings(t, seen, errors, kinds, rng) if k % 4 == 3 else []
        rows.append(Step(t, pose, odometry, readings))
    return rows


def _readings(
    t: int, pose: Pose, errors: Errors, kinds: tuple[str, ...], rng: np.random.Generator
) -> list[Reading]:
    readings = []
    for index, beacon in enumerate(BEACONS):
        azimuth, distance = sight(pose, beacon, errors.mount)
        told = {
            "azimuth": (
                wrap(azimuth + errors.azimuth_bias + rng.normal(0, errors.azimuth_std)),
                errors.azimuth_std,
            ),
            "range": (distance + errors.range_bias + rng.normal(0, errors.range_std), errors.range_std),
        }
        readings += [Reading(kind, t, t, (told[kind][0],), (told[kind][1],), index) for kind in kinds]
    return sorted(readings, key=lambda reading: reading.kind)
