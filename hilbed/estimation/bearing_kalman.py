"""Kalman filters of distance and angle of one landmark: Ishikawa & Sampei (1994), (18) and (19) mended."""

from __future__ import annotations

from math import cos, nan, sin
from typing import NamedTuple

from hilbed.angles import wrap
from hilbed.estimation.bearing_observers import State, bounded, reduced_rates


class Noise(NamedTuple):
    """What a filter is told: Q = diag(m²/m, rad²/m) per metre of travel, R, and P at the start.

    R: rad² m for Kalman–Bucy (per metre), rad² for the sampled filter (per measurement). P₀ is free.
    """

    Q: tuple[float, float] = (1.0e3, 0.2)
    R: float = 1.0e-3
    P0: tuple[float, float] = (1.0, 0.1)


def covariance_rates(state: State, Q: tuple[float, float]) -> tuple[float, float, float]:
    """Returns the elements 11, 12, 22 of F P + P Fᵀ + Q, F₂₂ = −cos φ / r as mended."""
    r, phi, P11, P12, P22 = state
    s, f21, f22 = sin(phi), sin(phi) / (r * r), -cos(phi) / r
    return -2.0 * s * P12 + Q[0], f21 * P11 + f22 * P12 - s * P22, 2.0 * (f21 * P12 + f22 * P22) + Q[1]


def sound(state: State, P0: tuple[float, float]) -> State:
    """Returns the state with a covariance that is positive: as it is, else that of the start."""
    r, phi, P11, P12, P22 = bounded(state)
    if P11 > 0.0 and P22 > 0.0 and P12 * P12 < P11 * P22:
        return r, phi, P11, P12, P22
    return r, phi, P0[0], 0.0, P0[1]


def nis(state: State, measured: float, variance: float) -> float:
    """Returns the normalised innovation squared of an angle measured with a variance (rad²)."""
    error = wrap(measured - state[1])
    return error * error / (state[4] + variance)


class KalmanBucy(NamedTuple):
    """The gain inside the differential equation: x̂' = f + (P₁₂, P₂₂)ᵀ φ̃ / R."""

    noise: Noise = Noise()

    def start(self, r: float, phi: float) -> State:
        return r, phi, self.noise.P0[0], 0.0, self.noise.P0[1]

    def rates(self, state: State, measured: float | None) -> State:
        state = sound(state, self.noise.P0)
        r, phi, _, P12, P22 = state
        dr, dphi = reduced_rates(r, phi)
        d11, d12, d22 = covariance_rates(state, self.noise.Q)
        if measured is None:
            return dr, dphi, d11, d12, d22
        k1, k2 = P12 / self.noise.R, P22 / self.noise.R
        error = wrap(measured - phi)
        return dr + k1 * error, dphi + k2 * error, d11 - k1 * P12, d12 - k1 * P22, d22 - k2 * P22

    def sound(self, state: State) -> State:
        return sound(state, self.noise.P0)

    def corrected(self, state: State, measured: float) -> State:  # noqa: ARG002
        return state

    def nis(self, state: State, measured: float, way: float) -> float:
        """Over a way (m) R is a variance R/way, and half of the correction K way has been made by its end."""
        if not way:
            return nan
        left = 1.0 - 0.5 * state[4] * way / self.noise.R
        return nis(state, measured, self.noise.R / way) / max(left, 0.5) ** 2


class SampledKalman(NamedTuple):
    """The continuous-discrete filter: predicts between measurements, updates at each, in Joseph's form."""

    noise: Noise = Noise()

    def start(self, r: float, phi: float) -> State:
        return r, phi, self.noise.P0[0], 0.0, self.noise.P0[1]

    def rates(self, state: State, measured: float | None) -> State:  # noqa: ARG002
        state = sound(state, self.noise.P0)
        return *reduced_rates(state[0], state[1]), *covariance_rates(state, self.noise.Q)

    def sound(self, state: State) -> State:
        return sound(state, self.noise.P0)

    def corrected(self, state: State, measured: float) -> State:
        r, phi, P11, P12, P22 = state
        R = self.noise.R
        S = P22 + R
        k1, k2 = P12 / S, P22 / S
        error = wrap(measured - phi)
        return bounded(
            (
                r + k1 * error,
                phi + k2 * error,
                P11 - 2.0 * k1 * P12 + k1 * k1 * S,
                (1.0 - k2) * (P12 - k1 * P22) + k1 * k2 * R,
                (1.0 - k2) ** 2 * P22 + k2 * k2 * R,
            )
        )

    def nis(self, state: State, measured: float, way: float) -> float:  # noqa: ARG002
        return nis(state, measured, self.noise.R)
