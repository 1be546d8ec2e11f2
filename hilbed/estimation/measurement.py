"""What a sensor should read of a beacon from a pose: azimuth and range with their Jacobians."""

from __future__ import annotations

from collections.abc import Callable
from math import atan2, cos, hypot, sin
from typing import NamedTuple

from hilbed.angles import wrap
from hilbed.types import Array

Point = tuple[float, float]


class Prediction(NamedTuple):
    """A predicted scalar: its value, its gradient over (x, y, yaw), and m or rad per m of the beacon.

    touching: whether the sensor stands on the beacon, from where the gradient is not what it says.
    """

    value: float
    gradient: tuple[float, float, float]
    per_metre: float
    touching: bool


class Model(NamedTuple):
    """One kind of reading: prediction from state, beacon and mount; difference of two values."""

    predict: Callable[[Array, Point, Point], Prediction]
    difference: Callable[[float, float], float]


NEAREST = 1e-3  # m: a robot that stands on a beacon still gets finite gradients


def _sight(state: Array, beacon: Point, mount: Point) -> tuple[float, float, float, float]:
    """Returns the map vector sensor → beacon and the derivative of the sensor's place over yaw."""
    x, y, yaw = state.tolist()
    c, s = cos(yaw), sin(yaw)
    lever_x, lever_y = c * mount[0] - s * mount[1], s * mount[0] + c * mount[1]
    return beacon[0] - x - lever_x, beacon[1] - y - lever_y, -lever_y, lever_x


def azimuth(state: Array, beacon: Point, mount: Point) -> Prediction:
    """Predicts h = atan2(b_y − c_y, b_x − c_x) − ψ (rad) from c = p + R(ψ)·mount.

    state: (3,) x, y, yaw; beacon (m, map); mount: the sensor in the robot's frame (m).
    """
    dx, dy, cx_yaw, cy_yaw = _sight(state, beacon, mount)
    squared = max(dx * dx + dy * dy, NEAREST**2)
    gx, gy = dy / squared, -dx / squared
    value = wrap(atan2(dy, dx) - float(state[2]))
    gradient = gx, gy, gx * cx_yaw + gy * cy_yaw - 1.0
    return Prediction(value, gradient, squared**-0.5, squared <= NEAREST**2)


def distance(state: Array, beacon: Point, mount: Point) -> Prediction:
    """Predicts the range |b − c| (m); arguments as in `azimuth`."""
    dx, dy, cx_yaw, cy_yaw = _sight(state, beacon, mount)
    length = max(hypot(dx, dy), NEAREST)
    gx, gy = -dx / length, -dy / length
    return Prediction(length, (gx, gy, gx * cx_yaw + gy * cy_yaw), 1.0, length <= NEAREST)


def _angle_between(a: float, b: float) -> float:
    return wrap(a - b)


def _length_between(a: float, b: float) -> float:
    return a - b


MODELS = {"azimuth": Model(azimuth, _angle_between), "range": Model(distance, _length_between)}
