"""Between a drive's numbers and SI units at the wheel."""

from __future__ import annotations

from math import tau
from typing import Literal

from hilbed.spec import Positive, Spec


class Units(Spec):
    """What a number in 60FF, 606C and 6064 is.

    counts_per_turn: of the shaft that carries the encoder; velocity: counts/s or rpm of that shaft;
    gear: turns of that shaft a turn of the wheel; polarity: −1 where the motor is mounted mirrored;
    rated_current: A, of which 6078 gives per mille.
    """

    counts_per_turn: Positive
    velocity: Literal["counts/s", "rpm"] = "counts/s"
    gear: Positive = 1.0
    polarity: Literal[-1, 1] = 1
    rated_current: Positive

    def position_scale(self, counts_per_turn: float | None = None) -> float:
        """Returns counts a radian at the wheel; another encoder may be given."""
        return (counts_per_turn or self.counts_per_turn) * self.gear * self.polarity / tau

    def velocity_scale(self, counts_per_turn: float | None = None) -> float:
        """Returns units of 60FF and 606C a rad/s at the wheel."""
        if self.velocity == "counts/s":
            return self.position_scale(counts_per_turn)
        return 60.0 * self.gear * self.polarity / tau
