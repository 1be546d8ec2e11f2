"""What the plant asks of an axis, whoever runs its firmware, and what an axis is made of."""

from __future__ import annotations

from typing import Protocol

from hilbed.types import Nanos


class Axis(Protocol):
    """One drive and its shaft, tick by tick.

    After a step, in the wheel's direction: current (A), duty −1 … 1, speed_ref (rad/s), NaN where nobody
    knows; supply_current (A, mean out of the supply). target: speed (rad/s) that the wheel is made to follow
    by no more than the torque `coulomb`; None where a torque turns it and `coulomb` (N m) is dry friction.
    """

    name: str
    current: float
    duty: float
    speed_ref: float
    supply_current: float
    coulomb: float
    target: float | None

    def present(self, angle: float, supply: int) -> None:
        """Shows its pins to a firmware elsewhere, before any firmware's answer of this tick is waited for.

        angle: rad, of the wheel; supply: quarters of a volt.
        """
        ...

    def idle(self, t: Nanos, angle: float, supply: int) -> None:
        """Runs a tick of the firmware alone: the shaft is held and carries no current."""
        ...

    def power(self, t: Nanos, on: bool) -> None:
        """Gives the firmware's logic its supply or takes it away; it boots when it comes back."""
        ...

    def step(self, t: Nanos, angle: float, speed: float, volts: float, supply: int) -> float:
        """Runs the tick that starts at `t` and returns the torque (N m) at the wheel, mean over the tick.

        angle (rad) and speed (rad/s): of the wheel; volts: of the supply, `supply` the same at its pin.
        """
        ...


class Train(Protocol):
    """Chopper, motor and gear of one wheel; `coulomb` is the dry friction (N m) the world lets act."""

    coulomb: float
    current: float
    supply_current: float

    def step(self, duty: float, enabled: bool, supply: float, wheel_speed: float) -> float: ...


class Encoder(Protocol):
    def sample(self, angle: float) -> int: ...
