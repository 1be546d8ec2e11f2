"""The battery that all drives share: it sags under their current."""

from __future__ import annotations

from hilbed.spec import NonNegative, Positive, Spec


class SupplySpec(Spec):
    """voltage V, open circuit; resistance Ω, internal, with its wiring."""

    voltage: Positive = 24.0
    resistance: NonNegative = 0.05


class Supply:
    """A voltage behind a resistance."""

    __slots__ = ("_resistance", "_voltage")

    def __init__(self, spec: SupplySpec) -> None:
        self._voltage = spec.voltage
        self._resistance = spec.resistance

    def voltage(self, current: float, drop: float) -> float:
        """Returns the voltage (V, never negative) that the drives see.

        current: A, sum of all drives over the last tick; drop: V that a disturbance takes off.
        """
        return max(self._voltage - drop - self._resistance * current, 0.0)
