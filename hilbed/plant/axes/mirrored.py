"""A drive that is mounted the other way round: its shaft turns backwards as the wheel turns forwards."""

from __future__ import annotations

from hilbed.plant.axes.axis import Axis
from hilbed.types import Nanos


class MirroredAxis:
    """An axis seen from the wheel: whatever has a direction changes its sign."""

    __slots__ = ("_axis", "coulomb", "current", "duty", "name", "speed_ref", "supply_current", "target")

    def __init__(self, axis: Axis) -> None:
        self._axis = axis
        self.name = axis.name
        self.coulomb = axis.coulomb
        self.target = axis.target
        self.current = self.duty = self.speed_ref = self.supply_current = 0.0

    def present(self, angle: float, supply: int) -> None:
        self._axis.present(-angle, supply)

    def idle(self, t: Nanos, angle: float, supply: int) -> None:
        self._axis.idle(t, -angle, supply)

    def power(self, t: Nanos, on: bool) -> None:
        self._axis.power(t, on)

    def step(self, t: Nanos, angle: float, speed: float, volts: float, supply: int) -> float:
        axis = self._axis
        torque = -axis.step(t, -angle, -speed, volts, supply)
        self.current, self.duty, self.speed_ref = -axis.current, -axis.duty, -axis.speed_ref
        self.supply_current = axis.supply_current
        return torque
