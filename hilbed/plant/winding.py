"""The current of a winding at a constant voltage, in closed form."""

from __future__ import annotations

from math import exp, log


def relax(current: float, target: float, tau: float, duration: float) -> tuple[float, float, float]:
    """Lets a current (A) relax for `duration` s towards `target`, with the time constant tau = L/R.

    i(t) = i∞ + (i₀ − i∞) exp(−t/τ). Returns its end (A), its integral (A s) and that of its square (A² s).
    """
    decay = exp(-duration / tau)
    away = current - target
    charge = target * duration + away * tau * (1.0 - decay)
    square = (
        target * target * duration
        + 2.0 * target * away * tau * (1.0 - decay)
        + 0.5 * away * away * tau * (1.0 - decay * decay)
    )
    return target + away * decay, charge, square


def reaches(current: float, target: float, level: float, tau: float) -> float:
    """Returns the time (s) until a current on its way to `target` crosses a level between the two."""
    return tau * log((current - target) / (level - target))


def through_diodes(
    current: float, rails: tuple[float, float], resistance: float, tau: float, duration: float
) -> tuple[float, float, float]:
    """Lets a current flow through diodes only, which stop it at zero.

    rails: the driving voltage (V, terminal less back-EMF) for a positive and for a negative current; between
    them nothing flows. Returns end, integral and integral of the square as `relax` does.
    """
    positive, negative = rails
    if current == 0.0 and positive <= 0.0 <= negative:
        return 0.0, 0.0, 0.0
    forward = current > 0.0 or (current == 0.0 and positive > 0.0)
    target = (positive if forward else negative) / resistance
    if (target >= 0.0) == forward:
        return relax(current, target, tau, duration)
    stop = min(reaches(current, target, 0.0, tau), duration)
    end, charge, square = relax(current, target, tau, stop)
    return (end if stop == duration else 0.0), charge, square
