"""The differential drive: two driven wheels on one axle, yaw from their difference."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from hilbed.spec import Finite, Listed, Positive, Spec
from hilbed.types import Command


class DiffDriveSpec(Spec):
    """Nominal geometry, as the controller knows it: wheel radius and track in m; URDF of the body.

    start: pose (m, m, rad) at t = 0, null for where the reference starts.
    """

    kind: Literal["diffdrive"] = "diffdrive"
    wheel_radius: Positive = 0.1
    track: Positive = 0.4
    urdf: str = "package:urdf/diffdrive.urdf"
    start: Listed[tuple[Finite, Finite, Finite]] | None = None

    @property
    def drives(self) -> tuple[str, ...]:
        """Names of its drives, in the order in which everybody lists them."""
        return DiffDrive.drives


class DiffDrive:
    """Kinematics of Slimane et al. 2014 (3): v = R (ω_l + ω_r) / 2, w = R (ω_r − ω_l) / E."""

    drives = ("left", "right")

    def __init__(self, spec: DiffDriveSpec) -> None:
        self._radius = spec.wheel_radius
        self._track = spec.track

    def wheel_speeds(self, command: Command) -> tuple[float, ...]:
        """Returns rad/s of the left and the right wheel for a command (m/s, rad/s)."""
        difference = command.w * self._track / 2
        return (command.v - difference) / self._radius, (command.v + difference) / self._radius

    def travel(self, turned: Sequence[float]) -> tuple[float, float]:
        """Returns distance (m) and turn (rad) for angles (rad) of the wheels, or v and w for rates."""
        left, right = turned
        return self._radius * (left + right) / 2, self._radius * (right - left) / self._track

    def limited(self, command: Command) -> Command:
        """Returns the command: its limits are those of its controller and its drives."""
        return command

    def twist(self, command: Command) -> tuple[float, float]:
        """Returns speed (m/s) of the axle's midpoint and yaw rate (rad/s): those of the command."""
        return command

    def command(self, v: float, w: float) -> Command:
        """Returns the command for a speed (m/s) and a yaw rate (rad/s) of the axle."""
        return Command(v, w)
