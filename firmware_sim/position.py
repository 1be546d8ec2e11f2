"""The position loop around the speed loop: it follows a demand, whoever moves it."""

from __future__ import annotations

from firmware_sim.error_rate import TICK


class PositionLoop:
    """Positions and errors in counts in the encoder's direction.

    demand: where the axis should be now; error: demand less position, at the last step; fastest: counts a
    tick, of the demand.
    """

    __slots__ = ("_gain", "_most", "_unit", "demand", "error", "fastest")

    def __init__(self, gain: float, unit: float, most: float) -> None:
        """gain: 1/s; unit: rad of one count; most: rad/s, of the demand and of the result."""
        self._gain = gain
        self._unit = unit
        self._most = most
        self.fastest = most * TICK / unit
        self.demand = self.error = 0.0

    def start(self, position: float) -> None:
        """Has the demand where the axis is."""
        self.demand = position
        self.error = 0.0

    def step(self, moved: float, position: float) -> float:
        """Moves the demand; returns the speed (rad/s) to follow in this tick: its own plus gain × error."""
        self.demand += moved
        self.error = error = self.demand - position
        speed = self._unit * (self._gain * error + moved / TICK)
        most = self._most
        return most if speed > most else -most if speed < -most else speed
