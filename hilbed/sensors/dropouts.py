"""Times in which a sensor has lost what it measures: a marker hidden, a satellite behind a house."""

from __future__ import annotations

from hilbed.clock import NEVER, nanos
from hilbed.types import Nanos, Rng


class Dropouts:
    """Comes and goes at random; both times are exponential, so it does not remember.

    rate: of losing it, 1/s, 0 for never; length: mean time (s) until it is found again.
    """

    def __init__(self, rate: float, length: float, rng: Rng) -> None:
        self._means = (1.0 / rate if rate else 0.0, length)  # s, in sight and out of it
        self._rng = rng
        self._out = False
        self._edge: Nanos = self._lasts() if rate else NEVER

    def out(self, t: Nanos) -> bool:
        """Tells whether it is lost at `t`, which never decreases from call to call."""
        while t >= self._edge:
            self._out = not self._out
            self._edge += self._lasts()
        return self._out

    def _lasts(self) -> Nanos:
        return nanos(float(self._rng.exponential(self._means[self._out])))
