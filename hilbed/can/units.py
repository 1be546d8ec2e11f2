"""Between a drive's numbers and SI units at the wheel."""

from __future__ import annotations

from math import tau
from typing import Annotated, Literal

from pydantic import Field

from hilbed.spec import Positive, Spec

Velocity = Literal["counts/s", "rpm", "rpm/10"]
Sign = Literal[-1, 1]

_PER_RPM = {"rpm": 1.0, "rpm/10": 10.0}


class Units(Spec):
    """What a number in 60FF, 606C, 6064 and the object of the current is.

    counts_per_turn: of the shaft that carries the encoder; velocity: counts/s, rpm or tenths of it, of that
    shaft; velocity_actual: that of 606C, where it is another; gear: turns of that shaft a turn of the wheel;
    polarity: −1 where the motor is mounted mirrored, a list for the axes of a node; rated_current: A, of
    which the current is given in per mille.
    """

    counts_per_turn: Positive
    velocity: Velocity = "counts/s"
    velocity_actual: Velocity | None = None
    gear: Positive = 1.0
    polarity: Sign | Annotated[list[Sign], Field(min_length=1)] = 1
    rated_current: Positive

    def sign(self, axis: int = 1) -> int:
        """Returns an axis's polarity."""
        return self.polarity[axis - 1] if isinstance(self.polarity, list) else self.polarity

    def position_scale(self, counts_per_turn: float | None = None, axis: int = 1) -> float:
        """Returns counts a radian at the wheel; another encoder may be given."""
        return (counts_per_turn or self.counts_per_turn) * self.gear * self.sign(axis) / tau

    def velocity_scale(self, counts_per_turn: float | None = None, axis: int = 1) -> float:
        """Returns units of 60FF a rad/s at the wheel."""
        return self._velocity_scale(self.velocity, counts_per_turn, axis)

    def actual_scale(self, counts_per_turn: float | None = None, axis: int = 1) -> float:
        """Returns units of 606C a rad/s at the wheel."""
        return self._velocity_scale(self.velocity_actual or self.velocity, counts_per_turn, axis)

    def amperes(self, axis: int = 1) -> float:
        """Returns A a number in the object of the current."""
        return self.rated_current * self.sign(axis) / 1000.0

    def _velocity_scale(self, unit: Velocity, counts_per_turn: float | None, axis: int) -> float:
        if unit == "counts/s":
            return self.position_scale(counts_per_turn, axis)
        return 60.0 * _PER_RPM[unit] * self.gear * self.sign(axis) / tau
