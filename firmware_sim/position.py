"""The position loop around the speed loop: it follows a demand that runs straight from target to target."""

from __future__ import annotations

from firmware_sim.error_rate import TICK


class PositionLoop:
    """Positions and errors in counts in the encoder's direction.

    demand: where the axis should be now; error: demand less position, at the last step.
    """

    __slots__ = ("_gain", "_goal", "_most", "_rate", "_unit", "demand", "error")

    def __init__(self, gain: float, unit: float, most: float) -> None:
        """gain: 1/s; unit: rad of one count; most: rad/s, of the demand and of the result."""
        self._gain = gain
        self._unit = unit
        self._most = most
        self._goal = self._rate = self.demand = self.error = 0.0

    def start(self, position: float) -> None:
        """Holds where the axis is."""
        self._goal = self.demand = position
        self._rate = self.error = 0.0

    def aim(self, goal: float, ticks: float) -> None:
        """Has the demand arrive at a goal after so many ticks, or later at the highest speed."""
        self._goal = goal
        fastest = self._most * TICK / self._unit
        self._rate = min(abs(goal - self.demand) / ticks, fastest)

    def step(self, position: float) -> float:
        """Returns the speed (rad/s) to follow in this tick: that of the demand plus gain × error."""
        left, rate = self._goal - self.demand, self._rate
        moved = rate if left > rate else -rate if left < -rate else left
        self.demand += moved
        self.error = error = self.demand - position
        speed = self._unit * (self._gain * error + moved / TICK)
        most = self._most
        return most if speed > most else -most if speed < -most else speed
