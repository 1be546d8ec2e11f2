"""What disturbances do right now: they write it, plant and sensors read it, the controller never sees it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from hilbed.types import Pose


class Effects:
    """The knobs of one tick; wheels in the order of the robot's drives.

    load_torque: N m at each wheel, positive against forward rotation; friction: coefficient under each
    wheel; radius: factor on each wheel's rolling radius; push: force (N, N) in the map on the body's
    centre of mass and torque (N m) about z; supply_drop: V off the supply's open-circuit voltage;
    spurious: mean number of false azimuths a frame; blind: the camera delivers nothing.
    """

    __slots__ = ("_friction", "blind", "friction", "load_torque", "push", "radius", "spurious", "supply_drop")

    def __init__(self, friction: Sequence[float]) -> None:
        self._friction = list(friction)
        self.load_torque: list[float] = []
        self.friction: list[float] = []
        self.radius: list[float] = []
        self.reset()

    def reset(self) -> None:
        """Takes every knob back to what it is without disturbances."""
        wheels = len(self._friction)
        self.load_torque[:] = [0.0] * wheels
        self.friction[:] = self._friction
        self.radius[:] = [1.0] * wheels
        self.push: tuple[float, float, float] = (0.0, 0.0, 0.0)
        self.supply_drop = 0.0
        self.spurious = 0.0
        self.blind = False


class Surroundings(Protocol):
    """What a disturbance may look at: where the robot is and where each wheel touches the ground (m, map)."""

    @property
    def pose(self) -> Pose: ...

    @property
    def wheels(self) -> Sequence[tuple[float, float]]: ...
