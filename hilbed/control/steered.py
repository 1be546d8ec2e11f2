"""Any controller of speed and yaw rate, on a robot that is told something else."""

from __future__ import annotations

from math import isclose

from hilbed.ports import Controller, Robot
from hilbed.tally import counts_of
from hilbed.types import Command, Estimate, Nanos

ROUNDING = 1e-9  # m/s and rad/s: what a command loses on its way through the robot's kinematics


class Steered:
    """Turns a controller's (v, w) into the robot's own command, such as a tricycle's (v, steering angle).

    `limited` counts the cycles in which the robot's limits of speed and steering do not allow what the
    controller asks for; `standing` those in which it should turn without moving, which only waits.
    """

    def __init__(self, controller: Controller, robot: Robot) -> None:
        self._controller = controller
        self._robot = robot
        self.limited = self.standing = 0

    def counts(self) -> dict[str, float]:
        """Returns what the controller has counted, and how often the robot could not follow it."""
        return {**counts_of(self._controller), "limited": self.limited, "standing": self.standing}

    def step(self, t: Nanos, estimate: Estimate) -> Command:
        """Returns the robot's command for the period from `t`."""
        asked = self._controller.step(t, estimate)
        command = self._robot.command(*asked)
        given = self._robot.twist(command)
        if not all(isclose(a, b, abs_tol=ROUNDING) for a, b in zip(asked, given, strict=True)):
            standing = abs(asked.v) < ROUNDING
            self.standing += standing
            self.limited += not standing
        return command
