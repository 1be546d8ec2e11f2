"""Observers of distance r and angle φ of one landmark from φ alone: Ishikawa & Sampei (1994), section 5.

All work per metre of travel. A robot that goes backwards is one that goes ahead with its heading turned by π,
so they know one direction only: their φ is that of the travel.
"""

from __future__ import annotations

from math import copysign, cos, nan, sin
from typing import NamedTuple, Protocol

from hilbed.angles import wrap

State = tuple[float, ...]
"""r (m), φ (rad); filters add their covariance P11, P12, P22."""

NEAREST, FARTHEST = 0.05, 100.0  # m: an estimated distance stays between
AXIS = 0.2  # of |sin φ|: where it is less the robot's axis passes through the landmark


class Observer(Protocol):
    """One observer; angles are measured φ of the travel (rad)."""

    def start(self, r: float, phi: float) -> State:
        """Returns the state for a guessed distance and the first measured angle."""
        ...

    def rates(self, state: State, measured: float | None) -> State:
        """Returns d(state)/ds without steering; no correction where nothing is measured."""
        ...

    def sound(self, state: State) -> State:
        """Returns a state that can be gone on from: the same, but for a covariance that is not positive."""
        ...

    def corrected(self, state: State, measured: float) -> State:
        """Returns the state after a measurement at one moment; the same where `rates` correct."""
        ...

    def nis(self, state: State, measured: float, way: float) -> float:
        """Returns the normalised innovation squared of a measurement; NaN where the observer has none.

        way: m since the measurement before.
        """
        ...


def bounded(state: State) -> State:
    """Returns the state with r between NEAREST and FARTHEST and φ in (−π, π]."""
    return min(max(state[0], NEAREST), FARTHEST), wrap(state[1]), *state[2:]


def reduced_rates(r: float, phi: float) -> tuple[float, float]:
    """Returns dr/ds = cos φ, dφ/ds = −sin φ / r, eq. (7), at standing steering; r counts from NEAREST."""
    return cos(phi), -sin(phi) / max(r, NEAREST)


class Lyapunov(NamedTuple):
    """Eq. (14) with (16), (17) mended: V = ½ε₂r̃² − ε r̃φ̃ + ½φ̃², ε = sign(sin φ) ε₁.

    V' = −|sin φ| ε₁ r̃²/(r r̂) + sin φ r̃φ̃/(r r̂) − k φ̃²/(4 ε₁ r̂²) is negative while r̂ |sin φ| < k r.
    The printed ε₂ = 2.0e-3 does not converge within the paper's run; 2.0e-4 does. ε₂ > ε₁².
    """

    epsilon_1: float = 1.0e-2
    epsilon_2: float = 2.0e-3
    k: float = 4.0

    def gain(self, r: float, phi: float) -> tuple[float, float]:
        """Returns what a unit of φ̃ adds to dr̂/ds and dφ̂/ds."""
        common = self.k / (4.0 * (self.epsilon_2 - self.epsilon_1**2) * r * r)
        return copysign(common, sin(phi)), common * self.epsilon_2 / self.epsilon_1

    def start(self, r: float, phi: float) -> State:
        return r, phi

    def rates(self, state: State, measured: float | None) -> State:
        r, phi = bounded(state)
        if measured is None:
            return reduced_rates(r, phi)
        k1, k2 = self.gain(r, measured)
        dr, dphi = reduced_rates(r, measured)
        error = wrap(measured - phi)
        return dr + k1 * error, dphi + k2 * error

    def sound(self, state: State) -> State:
        return state

    def corrected(self, state: State, measured: float) -> State:  # noqa: ARG002
        return state

    def nis(self, state: State, measured: float, way: float) -> float:  # noqa: ARG002
        return nan


class Luenberger(NamedTuple):
    """The extended Luenberger observer, eq. (20): the error's poles are the roots of s² + p₂ s + p₁.

    floor: least |sin φ̂| in the gain, or a noisy observer is lost where the axis passes through the landmark.
    """

    p1: float = 64.0
    p2: float = 16.0
    floor: float = AXIS

    def gain(self, r: float, phi: float) -> tuple[float, float]:
        """Returns what a unit of φ̃ adds to dr̂/ds and dφ̂/ds."""
        s = sin(phi)
        floored = copysign(max(abs(s), self.floor), s)
        return self.p1 * r * r / floored - s, self.p2 + 2.0 * cos(phi) / r

    def start(self, r: float, phi: float) -> State:
        return r, phi

    def rates(self, state: State, measured: float | None) -> State:
        r, phi = bounded(state)
        dr, dphi = reduced_rates(r, phi)
        if measured is None:
            return dr, dphi
        k1, k2 = self.gain(r, phi)
        error = wrap(measured - phi)
        return dr + k1 * error, dphi + k2 * error

    def sound(self, state: State) -> State:
        return state

    def corrected(self, state: State, measured: float) -> State:  # noqa: ARG002
        return state

    def nis(self, state: State, measured: float, way: float) -> float:  # noqa: ARG002
        return nan
