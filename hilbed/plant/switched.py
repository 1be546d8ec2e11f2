"""The chopper switch by switch: piecewise exponentials over every PWM period of a tick."""

from __future__ import annotations

from hilbed.plant.chopper import Switched, Tick, open_bridge, periods
from hilbed.plant.winding import reaches, relax, through_diodes


class SwitchedStage:
    """One leg chops, the other holds the polarity of the duty low; exact between switching instants.

    `ripple` (A) is the peak-to-peak current of the last period of the last tick.
    """

    __slots__ = (
        "_charge",
        "_dead",
        "_diode",
        "_diode_charge",
        "_drawn",
        "_dt",
        "_high",
        "_limit",
        "_low",
        "_period",
        "_periods",
        "_resistance",
        "_square",
        "_tau",
    )  # fmt: skip

    def __init__(self, spec: Switched, resistance: float, inductance: float, dt: float) -> None:
        """Takes the winding's R (Ω) and L (H) and the tick (s); raises ValueError if they do not fit."""
        self._periods = periods(spec, dt)
        self._period = dt / self._periods
        self._dead = spec.dead_time
        self._diode = spec.diode_drop
        self._dt = dt
        self._limit = spec.current_limit
        self._resistance = resistance + spec.resistance
        self._tau = inductance / self._resistance
        self._low = self._high = 0.0

    @property
    def ripple(self) -> float:
        return self._high - self._low

    def coast(self, current: float, supply: float, emf: float) -> Tick:
        volts = (supply, 2.0 * self._diode, emf)
        return open_bridge(current, volts, self._resistance, self._tau, self._dt)

    def drive(self, current: float, duty: float, supply: float, emf: float, ramp: float) -> Tick:
        side = 1.0 if duty >= 0.0 else -1.0
        self._charge = self._drawn = self._square = self._diode_charge = 0.0
        current *= side
        for k in range(self._periods):
            now = emf + ramp * ((k + 0.5) / self._periods - 0.5)
            current = self._one_period(current, abs(duty), supply, side * now)
        heat = self._resistance * self._square + self._diode * self._diode_charge
        return side * current, side * self._charge / self._dt, self._drawn / self._dt, heat

    def _one_period(self, current: float, duty: float, supply: float, emf: float) -> float:
        """Runs off/2, dead, on, dead, off/2; currents and voltages in the direction of the duty."""
        self._low = self._high = current
        if abs(current) >= self._limit:
            return self._trip(current, supply, emf)
        on, off, dead = self._times(duty)
        current = self._conduct(current, -emf, 0.5 * off)
        current = self._freewheel(current, supply, emf, dead)
        current, cut = self._drive(current, supply, emf, on)
        current = self._freewheel(current, supply, emf, dead)
        return self._conduct(current, -emf, 0.5 * off + cut)

    def _times(self, duty: float) -> tuple[float, float, float]:
        """Returns how long the leg is high, low and open at each edge; too short a pulse is left out."""
        on = min(duty, 1.0) * self._period - self._dead
        off = self._period - on - 2.0 * self._dead
        if on <= 0.0:
            return 0.0, self._period, 0.0
        if off <= 0.0:
            return self._period, 0.0, 0.0
        return on, off, self._dead

    def _drive(self, current: float, supply: float, emf: float, duration: float) -> tuple[float, float]:
        """Connects the supply; returns the current and the time cut off where it reached the limit."""
        if duration == 0.0:
            return current, 0.0
        target = (supply - emf) / self._resistance
        on = duration
        if current >= self._limit:
            on = 0.0
        elif target > self._limit:
            on = min(duration, reaches(current, target, self._limit, self._tau))
        before = self._charge
        current = self._conduct(current, supply - emf, on)
        self._drawn += self._charge - before
        return current, duration - on

    def _conduct(self, current: float, volts: float, duration: float) -> float:
        """Lets the current relax through two closed switches."""
        end, charge, square = relax(current, volts / self._resistance, self._tau, duration)
        return self._note(end, charge, square)

    def _freewheel(self, current: float, supply: float, emf: float, duration: float) -> float:
        """Both switches of the leg open: a driving current runs through the low diode, another one goes
        back into the supply through the high diode, and either stops at zero."""
        rails = (-self._diode - emf, supply + self._diode - emf)
        end, charge, square = through_diodes(current, rails, self._resistance, self._tau, duration)
        self._diode_charge += abs(charge)
        self._drawn += min(charge, 0.0)
        return self._note(end, charge, square)

    def _trip(self, current: float, supply: float, emf: float) -> float:
        """Opens the whole bridge for a period: what a current beyond the limit, braking, comes to."""
        drops = supply + 2.0 * self._diode
        end, charge, square = through_diodes(
            current, (-drops - emf, drops - emf), self._resistance, self._tau, self._period
        )
        self._diode_charge += 2.0 * abs(charge)
        self._drawn -= abs(charge)
        return self._note(end, charge, square)

    def _note(self, end: float, charge: float, square: float) -> float:
        self._charge += charge
        self._square += square
        self._low = min(self._low, end)
        self._high = max(self._high, end)
        return end
