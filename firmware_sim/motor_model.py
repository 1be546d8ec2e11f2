"""What the firmware believes of its motor: enough to keep the current within a limit by the duty alone."""

from __future__ import annotations


class MotorModel:
    """resistance Ω, emf V s (back-EMF at the wheel: K_e times gear ratio), limit A."""

    __slots__ = ("_drop", "emf", "limit", "resistance")

    def __init__(self, resistance: float, emf: float, limit: float) -> None:
        self.resistance = resistance
        self.emf = emf
        self.limit = limit
        self._drop = resistance * limit  # V

    def window(self, speed: float, voltage: float) -> tuple[float, float]:
        """Returns the lowest and highest duty that keep |i| ≤ limit at this speed, within [−1, 1].

        From the steady state of U d = R i + K_e N w: d = (K_e N w ± R i_max) / U. Where the speed
        alone drives more current than that, both ends are the full duty against it.
        """
        if voltage < 1.0:
            voltage = 1.0
        middle = self.emf * speed / voltage
        half = self._drop / voltage
        low = middle - half
        high = middle + half
        low = -1.0 if low < -1.0 else 1.0 if low > 1.0 else low
        high = -1.0 if high < -1.0 else 1.0 if high > 1.0 else high
        return low, high

    def coasting(self, speed: float, voltage: float) -> float:
        """Returns the duty that drives no current at this speed."""
        return max(-1.0, min(1.0, self.emf * speed / max(voltage, 1.0)))
