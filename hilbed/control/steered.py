"""Any controller of speed and yaw rate, on a robot that is told something else."""

from __future__ import annotations

from collections.abc import Callable

from hilbed.ports import Controller
from hilbed.tally import counts_of
from hilbed.types import Command, Estimate, Nanos


class Steered:
    """Turns a controller's (v, w) into the robot's own command, such as a tricycle's (v, steering angle)."""

    def __init__(self, controller: Controller, command: Callable[[float, float], Command]) -> None:
        self._controller = controller
        self._command = command

    def counts(self) -> dict[str, float]:
        """Returns what the controller has counted."""
        return counts_of(self._controller)

    def step(self, t: Nanos, estimate: Estimate) -> Command:
        """Returns the robot's command for the period from `t`."""
        v, w = self._controller.step(t, estimate)
        return self._command(v, w)
