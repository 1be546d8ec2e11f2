"""Tracking a reference by a Lyapunov function: Bui & Duong (2022), section 3.3."""

from __future__ import annotations

from math import cos, pi, sin
from typing import NamedTuple

from hilbed.control.lqr import body_error
from hilbed.control.lyapunov_spec import LyapunovTrackingSpec
from hilbed.ports import Reference
from hilbed.types import Command, Estimate, Nanos, Pose


class Gains(NamedTuple):
    """k₁ (1/s), k₂ (rad/m²), k₃ (rad/m)."""

    k1: float
    k2: float
    k3: float


def tracking_twist(
    error: tuple[float, float, float], reference: tuple[float, float], gains: Gains
) -> tuple[float, float]:
    """Returns u₁ = v_r cos θ_e + k₁ x_e and u₂ = θ̇_r + v_r (k₂ y_e + k₃ sin θ_e), eq. (3.13).

    error: x_e, y_e (m), θ_e (rad) in the robot's frame; reference: v_r (m/s), θ̇_r (rad/s). With
    V = ½ (x_e² + y_e²) + (1 − cos θ_e)/k₂ it makes V' = −k₁ x_e² − (k₃/k₂) v_r sin² θ_e, for v_r ≥ 0.
    """
    x, y, turn = error
    v, w = reference
    return v * cos(turn) + gains.k1 * x, w + v * (gains.k2 * y + gains.k3 * sin(turn))


class LyapunovTracking:
    """The law on a reference; `beyond` counts cycles with |θ_e| > π/2, for which it was not made."""

    def __init__(self, spec: LyapunovTrackingSpec, reference: Reference) -> None:
        self._gains = Gains(spec.k1, spec.k2, spec.k3)
        self._reference = reference
        self.beyond = 0

    def counts(self) -> dict[str, float]:
        """Returns in how many cycles the law was asked for what it was not made for."""
        return {"beyond": self.beyond}

    def step(self, t: Nanos, estimate: Estimate) -> Command:
        """Returns v (m/s) and w (rad/s) for the period from `t`."""
        x, y, yaw = estimate.mean.tolist()
        pose, v, w = self._reference.at(t)
        error = body_error(pose, Pose(x, y, yaw))
        self.beyond += abs(error[2]) > pi / 2
        return Command(*tracking_twist(error, (v, w), self._gains))
