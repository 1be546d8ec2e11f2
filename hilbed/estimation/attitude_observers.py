"""The three attitude observers of Pliego-Jiménez (2023) by their form."""

from __future__ import annotations

from cmath import rect
from collections.abc import Callable
from typing import Protocol

import numpy as np

from hilbed.estimation.attitude import Motion, global_step, s1_step, so2_step

SHORTEST = 1e-3  # of Θ̄: a shorter one points nowhere


class Observer(Protocol):
    """What holds a heading as a complex number; its step replaces it."""

    heading: complex

    def step(self, motion: Motion) -> None: ...


class So2:
    """R̂ (2, 2), a rotation."""

    def __init__(self, yaw: float, gain: float) -> None:
        start = rect(1.0, yaw)
        self._R = np.array(((start.real, -start.imag), (start.imag, start.real)))
        self._gain = gain
        self.heading = start

    def step(self, motion: Motion) -> None:
        self._R = so2_step(self._R, motion, self._gain)
        self.heading = complex(self._R[0, 0], self._R[1, 0])


class S1:
    """Θ̂ on the unit circle."""

    def __init__(self, yaw: float, gain: float) -> None:
        self.heading = rect(1.0, yaw)
        self._gain = gain

    def step(self, motion: Motion) -> None:
        self.heading = s1_step(self.heading, motion, self._gain)


class Global:
    """Θ̄ anywhere in the plane; where it is too short to point, the heading is carried by the turn."""

    def __init__(self, yaw: float, gain: float) -> None:
        self.heading = self._Θ = rect(1.0, yaw)
        self._gain = gain

    def step(self, motion: Motion) -> None:
        self._Θ = global_step(self._Θ, motion, self._gain)
        length = abs(self._Θ)
        self.heading = self._Θ / length if length > SHORTEST else self.heading * rect(1.0, motion.turn)


OBSERVERS: dict[str, Callable[[float, float], Observer]] = {"so2": So2, "s1": S1, "global": Global}
"""From a first guess of the yaw (rad) and a gain."""
