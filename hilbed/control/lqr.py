"""Tracking by a linear-quadratic regulator of the error in the robot's frame."""

from __future__ import annotations

from math import copysign, cos, pi, sin

import numpy as np

from hilbed.angles import wrap
from hilbed.clock import seconds
from hilbed.control.lqr_spec import LqrSpec
from hilbed.ports import Reference
from hilbed.types import Array, Command, Estimate, Nanos, Pose

Row = tuple[float, float, float]

SLOWEST = 0.05  # m/s: an axle that stands cannot be steered aside, so gains are those of this speed
GRID = 0.05  # m/s and rad/s: reference speeds are rounded to it before a gain is solved and kept


def error_model(v: float, w: float) -> tuple[Array, Array]:
    """Returns A (3, 3), B (3, 2) of ė = A e − B (dv, dw) at reference speeds v (m/s), w (rad/s).

    Slimane et al. (2014), section on the controller, for the error in the robot's frame.
    """
    A = np.array([[0, w, 0], [-w, 0, v], [0, 0, 0]], dtype=float)
    B = np.array([[1, 0], [0, 0], [0, 1]], dtype=float)
    return A, B


def solve_gain(v: float, w: float, period: float, Q: Array, R: Array) -> Array:
    """Returns K (2, 3) of (dv, dw) = K e, held over a period (s), that minimises Σ eᵀQe + uᵀRu.

    A and B are discretised exactly: exp([[A, B], [0, 0]] T).
    """
    from scipy.linalg import expm, solve_discrete_are

    A, B = error_model(v, w)
    block = np.zeros((5, 5))
    block[:3, :3], block[:3, 3:] = A, B
    held = expm(block * period)
    Ad, Bd = held[:3, :3], held[:3, 3:]
    P = solve_discrete_are(Ad, Bd, Q, R)
    return np.asarray(np.linalg.solve(R + Bd.T @ P @ Bd, Bd.T @ P @ Ad), dtype=np.float64)


def body_error(reference: Pose, robot: Pose) -> tuple[float, float, float]:
    """Returns reference − robot in the robot's frame (m, m, rad)."""
    c, s = cos(robot.yaw), sin(robot.yaw)
    dx, dy = reference.x - robot.x, reference.y - robot.y
    return c * dx + s * dy, c * dy - s * dx, wrap(reference.yaw - robot.yaw)


class Lqr:
    """v = v_r cos e_ψ + dv, w = w_r + dw with (dv, dw) = K(v_r, w_r) e, then limited.

    `beyond` counts cycles with |e_ψ| > π/2, far from where the error model was linearised; `saturated` those
    in which the law asks for more than max_speed or max_turn_rate.
    """

    def __init__(self, spec: LqrSpec, reference: Reference, period: Nanos) -> None:
        self._reference = reference
        self._period = seconds(period)
        self._Q = np.diag(np.power(spec.error, -2.0))
        self._R = np.diag(np.power(spec.effort, -2.0))
        self._limits = spec.max_speed, spec.max_turn_rate
        self._gains: dict[tuple[int, int], tuple[Row, Row]] = {}
        self.beyond = self.saturated = 0
        self._gain(*reference.at(0)[1:])  # brings scipy in before the first cycle

    def counts(self) -> dict[str, float]:
        """Returns in how many cycles the law was asked for what it was not made for."""
        return {"beyond": self.beyond, "saturated": self.saturated}

    def step(self, t: Nanos, estimate: Estimate) -> Command:
        """Returns the command for the period from `t`."""
        x, y, yaw = estimate.mean.tolist()
        pose, v, w = self._reference.at(t)
        ex, ey, turn = body_error(pose, Pose(x, y, yaw))
        self.beyond += abs(turn) > pi / 2
        (vx, vy, vt), (wx, wy, wt) = self._gain(v, w)
        speed = v * cos(turn) + vx * ex + vy * ey + vt * turn
        turn_rate = w + wx * ex + wy * ey + wt * turn
        command = Command(_limited(speed, self._limits[0]), _limited(turn_rate, self._limits[1]))
        self.saturated += command != (speed, turn_rate)
        return command

    def _gain(self, v: float, w: float) -> tuple[Row, Row]:
        key = round(v / GRID), round(w / GRID)
        if key not in self._gains:
            near = copysign(max(abs(key[0] * GRID), SLOWEST), v)
            K = solve_gain(near, key[1] * GRID, self._period, self._Q, self._R).tolist()
            self._gains[key] = (K[0][0], K[0][1], K[0][2]), (K[1][0], K[1][1], K[1][2])
        return self._gains[key]


def _limited(value: float, limit: float) -> float:
    return min(max(value, -limit), limit)
