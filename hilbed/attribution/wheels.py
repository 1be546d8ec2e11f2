"""Odometry taken apart: what the wheels turned, what of it was slip, what the robot's model got wrong."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from hilbed.angle_arrays import wrap
from hilbed.record.readings import Signals
from hilbed.robots import ROBOTS, RobotSpec
from hilbed.types import Array

SLIP, ENCODER, MODEL = "slip", "encoder resolution and latency", "odometry integration and geometry"
ODOMETRY = "odometry"
STEERING = "steering"
NOTHING = 1e-9  # m, rad, m/s, rad/s


class Steps(NamedTuple):
    """Odometry row by row, (N, 5): sampled (s), distance (m), turn (rad), v (m/s), w (rad/s).

    measured: as recorded; exact: as exact encoders without delay would have told it; slip, model: what of
    either is slip, or what the robot's model has wrong, for the rows of measured and of exact. Without
    records of the wheels there are only `measured` and `true`, by the true poses.
    """

    measured: Array
    true: Array
    exact: Array | None = None
    slip: tuple[Array, Array] | None = None
    model: tuple[Array, Array] | None = None

    @property
    def sources(self) -> tuple[str, ...]:
        if self.exact is not None:
            return SLIP, ENCODER, MODEL
        return (ODOMETRY,) if np.abs(self.measured - self.true).max() > NOTHING else ()

    def replaced(self, sources: frozenset[str]) -> Array:
        """Returns the rows with the named sources replaced by truth."""
        if self.exact is None or self.slip is None or self.model is None:
            return self.true if ODOMETRY in sources else self.measured
        exact = ENCODER in sources
        rows = (self.exact if exact else self.measured).copy()
        if SLIP in sources:
            rows[:, 1:] -= self.slip[exact]
        if MODEL in sources:
            rows[:, 1:] -= self.model[exact]
        return rows


def steps_of(robot: RobotSpec, signals: Signals) -> Steps:
    """Returns the odometry of a run and its parts, as far as it has recorded its wheels at the tick."""
    t, measured = signals["t"], signals["odometry_step"]
    way = Way(t, signals["truth"])
    true = np.column_stack((t, way.steps(t), way.rates(t)))
    if "tick/t" not in signals:
        return Steps(measured, true)
    sampled = measured[:, 0]
    turned, slipped = _travel(robot, signals)
    times = signals["tick/t"]
    parts = [Part(times, turned, way, slipped, at) for at in (sampled, t)]
    exact = np.column_stack((t, parts[1].turned))
    return Steps(measured, true, exact, (parts[0].slip, parts[1].slip), (parts[0].model, parts[1].model))


class Way:
    """Where the robot truly was: poses (N, 3) at times (N,) s."""

    def __init__(self, t: Array, poses: Array) -> None:
        self._t = t
        known = np.isfinite(poses).all(axis=1)
        yaw = np.unwrap(poses[known, 2])
        self._columns = [(t[known], column) for column in (poses[known, 0], poses[known, 1], yaw)]

    def steps(self, at: Array) -> Array:
        """Returns way along the arc (m) and turn (rad) since the row before, (N, 2); zeros in the first."""
        x, y, yaw = (np.interp(at, t, column) for t, column in self._columns)
        turn = np.diff(yaw)
        middle = yaw[:-1] + turn / 2
        ahead = np.diff(x) * np.cos(middle) + np.diff(y) * np.sin(middle)
        return np.vstack(([0.0, 0.0], np.column_stack((ahead / np.sinc(turn / (2 * np.pi)), wrap(turn)))))

    def rates(self, at: Array) -> Array:
        """Returns speed (m/s) and yaw rate (rad/s) since the row before, (N, 2)."""
        return rates(self.steps(at), at)


def rates(steps: Array, at: Array) -> Array:
    """Returns steps (N, 2) over the time since the row before; zeros where no time has passed."""
    lasted = np.diff(at, prepend=at[0])
    return np.divide(steps, lasted[:, None], out=np.zeros_like(steps), where=lasted[:, None] > 0)


class Part:
    """What the wheels say between the moments `at`, and what of that is slip or the model's error; (N, 4)."""

    def __init__(self, times: Array, turned: Array, way: Way, slipped: Array, at: Array) -> None:
        """turned, slipped: way and turn since the start by the wheels, by their slip; (M, 2) at `times`."""
        told = self._steps(times, turned, at)
        slip = self._steps(times, slipped, at)
        model = told - slip - way.steps(at)
        self.turned, self.slip, self.model = (
            np.hstack((part, rates(part, at))) for part in (told, slip, model)
        )

    @staticmethod
    def _steps(times: Array, total: Array, at: Array) -> Array:
        reached = np.column_stack([np.interp(at, times, column) for column in total.T])
        return np.diff(reached, axis=0, prepend=reached[:1])


def _travel(robot: RobotSpec, signals: Signals) -> tuple[Array, Array]:
    """Returns way and turn (M, 2) since the start by the wheels' true rotation, and what of it was slip."""
    times = signals["tick/t"]
    tick = np.diff(times, prepend=times[0])
    wheels = [name for name in robot.drives if name != STEERING]
    speeds = [signals[f"tick/drive/{name}/speed"] for name in wheels]
    slips = [signals[f"tick/drive/{name}/slip"] / robot.wheel_radius for name in wheels]
    angles = [signals[f"tick/drive/{name}/angle"] for name in robot.drives if name == STEERING]
    turned = _rates_of(robot, [*speeds, *angles])
    rolling = _rates_of(robot, [*(v - s for v, s in zip(speeds, slips, strict=True)), *angles])
    return np.cumsum(turned * tick[:, None], axis=0), np.cumsum((turned - rolling) * tick[:, None], axis=0)


def _rates_of(robot: RobotSpec, turning: Sequence[Array]) -> Array:
    travel = ROBOTS[robot.kind](robot).travel
    return np.array([travel(one) for one in zip(*(column.tolist() for column in turning), strict=True)])
