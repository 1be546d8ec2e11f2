"""An observer of one landmark carried along what the odometer says."""

from __future__ import annotations

from math import ceil, pi
from typing import NamedTuple

from hilbed.angles import wrap
from hilbed.estimation.bearing_observers import Observer, State, bounded

COASTING = 0.01  # m: without a correction nothing moves fast; a step of this is exact to 1e-8


class Leg(NamedTuple):
    """A piece of the way: distance (m, negative backwards), turn (rad), both even over it.

    measured: φ (rad) at its start and its end, straight in between; None where nothing was measured.
    """

    distance: float
    turn: float
    measured: tuple[float, float] | None = None


def travelled(observer: Observer, state: State, leg: Leg, step: float) -> State:
    """Returns the state after a leg, by Runge–Kutta steps of at most `step` (m), longer where it coasts.

    Backwards the heading is turned by π for the while, which is all that changes. A robot that turns on the
    spot learns nothing and keeps φ in step.
    """
    if leg.distance == 0.0:
        return bounded((state[0], state[1] + leg.turn, *state[2:]))
    flip = pi if leg.distance < 0.0 else 0.0
    longest = step if leg.measured else max(step, COASTING)
    steps = ceil(abs(leg.distance) / longest)
    state = bounded((state[0], state[1] + flip, *state[2:]))
    for k in range(steps):
        state = bounded(_rk4(observer, state, _part(leg, k / steps, (k + 1) / steps, flip)))
    return bounded((state[0], state[1] - flip, *state[2:]))


def _part(leg: Leg, start: float, end: float, flip: float) -> Leg:
    """Returns a part of a leg, ahead and with the angles of the travel."""
    share = end - start
    measured = None
    if leg.measured is not None:
        first, change = leg.measured[0] + flip, wrap(leg.measured[1] - leg.measured[0])
        measured = first + start * change, first + end * change
    return Leg(abs(leg.distance) * share, leg.turn * share, measured)


def _rk4(observer: Observer, x: State, leg: Leg) -> State:
    """The classical step over a whole part: distances times rates, and the turn, which φ follows."""
    a, b = leg.measured or (None, None)
    middle = None if a is None or b is None else 0.5 * (a + b)
    k1 = _change(observer, x, a, leg)
    k2 = _change(observer, _plus(x, k1, 0.5), middle, leg)
    k3 = _change(observer, _plus(x, k2, 0.5), middle, leg)
    k4 = _change(observer, _plus(x, k3, 1.0), b, leg)
    return tuple(
        xi + (p + 2.0 * q + 2.0 * r + s) / 6.0 for xi, p, q, r, s in zip(x, k1, k2, k3, k4, strict=True)
    )


def _change(observer: Observer, x: State, measured: float | None, leg: Leg) -> State:
    dr, dphi, *rest = observer.rates(x, measured)
    ds = leg.distance
    return ds * dr, ds * dphi + leg.turn, *(ds * rate for rate in rest)


def _plus(x: State, change: State, share: float) -> State:
    return tuple(xi + share * d for xi, d in zip(x, change, strict=True))
