"""The chopper: what the power stage makes of a duty, by default averaged over its PWM period."""

from __future__ import annotations

from math import exp
from typing import Annotated, Literal, Protocol, TypeAlias

from pydantic import Field

from hilbed.plant.winding import reaches, relax, through_diodes
from hilbed.spec import NonNegative, Positive, Spec, Word


class Averaged(Spec):
    """An H bridge without its ripple: terminal voltage = duty × supply − resistance × current.

    resistance Ω of the two closed switches in the current's path; diode_drop V of one diode (the current of
    an open bridge runs back into the supply through two); current_limit A, held by the power stage.
    """

    kind: Literal["averaged"] = "averaged"
    resistance: NonNegative = 0.02
    diode_drop: NonNegative = 0.8
    current_limit: Positive = 15.0


class Switched(Spec):
    """The same bridge, switch by switch: one leg chops, the other holds the polarity low.

    frequency Hz of the PWM, a multiple of the tick rate; dead_time s, both switches of the chopping leg open
    at each edge. The ripple's middle falls on the tick, where a drive samples its current.
    """

    kind: Literal["switched"] = "switched"
    frequency: Positive = 20e3
    dead_time: NonNegative = 0.5e-6
    resistance: NonNegative = 0.02
    diode_drop: NonNegative = 0.8
    current_limit: Positive = 15.0


def periods(spec: Switched, dt: float) -> int:
    """Returns how many PWM periods a tick (s) has; raises ValueError where chopper and tick do not fit."""
    count = round(spec.frequency * dt)
    if count < 1 or abs(count - spec.frequency * dt) > 1e-6:
        raise ValueError(f"PWM frequency {spec.frequency:g} Hz is not a multiple of the tick's {1 / dt:g} Hz")
    if 2.0 * spec.dead_time >= dt / count:
        raise ValueError(f"dead_time {spec.dead_time:g} s: two of them fill the PWM period")
    return count


Chopper = Annotated[Averaged | Switched, Field(discriminator="kind"), Word]


Tick: TypeAlias = tuple[float, float, float, float]
"""One tick of a winding: current at its end (A), its mean (A), mean current out of the supply (A), heat in
winding and bridge (J)."""


class Stage(Protocol):
    """A power stage with the winding it feeds."""

    def drive(self, current: float, duty: float, supply: float, emf: float, ramp: float) -> Tick:
        """Runs a tick with the bridge on, from `current` (A) and with `supply` (V) held.

        emf: V at mid-tick; ramp: V by which it rises over the tick (in the heat to first order only).
        """
        ...

    def coast(self, current: float, supply: float, emf: float) -> Tick:
        """Runs a tick with every switch open: the current dies into the supply through two diodes."""
        ...


class AveragedStage:
    """Exact over the tick: the winding relaxes once, with factors that depend on the tick alone."""

    __slots__ = (
        "_admittance", "_cross", "_decay", "_diodes", "_dt", "_heating", "_limit", "_mean", "_ramp_end",
        "_ramp_mean", "_resistance", "_tau",
    )  # fmt: skip

    def __init__(self, spec: Averaged, resistance: float, inductance: float, dt: float) -> None:
        """Takes the winding's R (Ω) and L (H) and the tick (s)."""
        self._resistance = resistance + spec.resistance
        self._admittance = 1.0 / self._resistance
        self._tau = tau = inductance / self._resistance
        self._dt = dt
        self._decay = exp(-dt / tau)
        self._mean = (1.0 - self._decay) * tau / dt
        self._cross = 2.0 * self._mean
        self._heating = 0.5 * (1.0 - self._decay**2) * tau / dt
        # For e(t) = e + s (t − dt/2): L di/dt = u − e(t) − R i has the particular solution
        # (u − e(t) + s τ) / R, and what is left of it at t = 0 decays.
        self._ramp_end = ((0.5 * dt - tau) + (0.5 * dt + tau) * self._decay) * self._admittance / dt
        self._ramp_mean = (tau - (0.5 * dt + tau) * self._mean) * self._admittance / dt
        self._limit = spec.current_limit
        self._diodes = 2.0 * spec.diode_drop

    def drive(self, current: float, duty: float, supply: float, emf: float, ramp: float) -> Tick:
        target = (duty * supply - emf) * self._admittance
        away = current - target
        end = target + away * self._decay - ramp * self._ramp_end
        if not -self._limit <= end <= self._limit:
            return self._limited(current, duty, supply, emf)
        bend = ramp * self._ramp_mean
        mean = target + away * self._mean + bend
        square = target * (target + self._cross * away) + self._heating * away * away + 2.0 * mean * bend
        return end, mean, duty * mean, self._resistance * self._dt * square

    def _limited(self, current: float, duty: float, supply: float, emf: float) -> Tick:
        """Runs a tick in which the current meets the limit and is held there by chopping."""
        target = (duty * supply - emf) * self._admittance
        limit = self._limit if target > 0.0 else -self._limit
        free = self._dt
        if abs(current) >= self._limit:
            free = 0.0
        elif abs(target) > self._limit:
            free = min(free, reaches(current, target, limit, self._tau))
        _, charge, square = relax(current, target, self._tau, free)
        held = self._dt - free
        # What is left of the duty while the bridge chops to hold the current.
        holding = (self._resistance * limit + emf) / supply if supply > 0.0 else 0.0
        mean = (charge + limit * held) / self._dt
        drawn = (duty * charge + holding * limit * held) / self._dt
        return limit, mean, drawn, self._resistance * (square + limit * limit * held)

    def coast(self, current: float, supply: float, emf: float) -> Tick:
        return open_bridge(current, (supply, self._diodes, emf), self._resistance, self._tau, self._dt)


def open_bridge(
    current: float, volts: tuple[float, float, float], resistance: float, tau: float, dt: float
) -> Tick:
    """Runs a tick of `Stage.coast`; volts: supply, drop of two diodes, back-EMF."""
    supply, drops, emf = volts
    rails = (-supply - drops - emf, supply + drops - emf)
    end, charge, square = through_diodes(current, rails, resistance, tau, dt)
    returned = abs(charge)
    return end, charge / dt, -returned / dt, resistance * square + drops * returned
