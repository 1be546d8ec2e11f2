"""How a position demand gets to its goal: in a straight line (CSP), or by a trapezoid of speed (PP).

Counts and ticks. `step` is given the demand and returns by how much it moves in this tick.
"""

from __future__ import annotations

from math import sqrt

from firmware_sim.ramp import approach


class Straight:
    """Arrives at its goal after the ticks of an interpolation period, or later at the highest speed."""

    __slots__ = ("_goal", "_rate")

    def __init__(self) -> None:
        self._goal = self._rate = 0.0

    def aim(self, goal: float, demand: float, ticks: float, fastest: float) -> None:
        """Takes the way from the demand to the goal over so many ticks; fastest: counts a tick."""
        self._goal = goal
        self._rate = min(abs(goal - demand) / ticks, fastest)

    def step(self, demand: float) -> float:
        left, rate = self._goal - demand, self._rate
        return rate if left > rate else -rate if left < -rate else left


class Trapezoid:
    """Speeds up, keeps a speed and brakes, so that it comes to rest at the goal.

    Exact for ramps that are straight within every tick: after k ticks of speeding up the way is k² rise / 2.
    A goal nearer than it can brake is passed and come back to. goal: counts; most: counts a tick; rise, fall:
    counts a tick²; speed: at the end of the last tick.
    """

    __slots__ = ("fall", "goal", "most", "rise", "speed")

    def __init__(self) -> None:
        self.goal = self.speed = self.most = 0.0
        self.rise = self.fall = 1.0

    def rest(self, position: float) -> None:
        """Stands at once, with its goal where it is."""
        self.goal = position
        self.speed = 0.0

    def step(self, demand: float) -> float:
        left, before, fall = self.goal - demand, self.speed, self.fall
        if left == before == 0.0:
            return 0.0
        if -fall <= before <= fall and left * before >= 0.0 and 2.0 * abs(left) <= abs(before):
            self.speed = 0.0  # it stands before the tick is over
            return left
        ahead = 1.0 if left > 0.0 else -1.0
        wanted = ahead * self._brakeable(ahead * left, ahead * before)
        self.speed = speed = approach(before, wanted, self.rise, fall)
        return 0.5 * (before + speed)

    def _brakeable(self, left: float, before: float) -> float:
        """Returns the highest speed v for this tick's end from which braking stops within what is left.

        (before + v)/2 + v²/(2 fall) = left.
        """
        half = 0.5 * self.fall
        room = half * half + self.fall * (2.0 * left - before)
        return min(self.most, sqrt(room) - half) if room > half * half else 0.0
