"""Inputs that grow with time: tests 1 to 3 of Bui & Duong (2022), section 2.2."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

from hilbed.clock import seconds
from hilbed.spec import Finite, Spec
from hilbed.types import Command, Estimate, Nanos


class RampSpec(Spec):
    """start + rate · t: m/s or rad, and per s."""

    start: Finite = 0.0
    rate: Finite = 0.0


class RampsSpec(Spec):
    """The robot's own command over time, within its limits: speed, and steering angle (or yaw rate).

    The paper prints the ramps' unit as rad/s; they are in rad.
    """

    kind: Literal["ramps"] = "ramps"
    speed: RampSpec = RampSpec(start=1.0)
    steering: RampSpec = RampSpec(rate=0.5)


def unlimited(command: Command) -> Command:
    """Returns the command as it is."""
    return command


class Ramps:
    """Both inputs at each period's start, as the robot takes them, whatever the pose.

    `limited` counts the cycles in which they were beyond the robot's limits.
    """

    def __init__(self, spec: RampsSpec, limit: Callable[[Command], Command] = unlimited) -> None:
        """limit: a command as the robot takes it."""
        self._spec = spec
        self._limit = limit
        self.limited = 0

    def counts(self) -> dict[str, float]:
        """Returns in how many cycles the ramps were beyond the robot's limits."""
        return {"limited": self.limited}

    def step(self, t: Nanos, estimate: Estimate) -> Command:  # noqa: ARG002
        """Returns the command for the period from `t`."""
        v, γ, s = self._spec.speed, self._spec.steering, seconds(t)
        asked = Command(v.start + v.rate * s, γ.start + γ.rate * s)
        command = self._limit(asked)
        self.limited += command != asked
        return command
