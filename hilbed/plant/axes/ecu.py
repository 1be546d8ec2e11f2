"""A drive whose firmware is a process elsewhere: chopper, motor and shaft are here, its pins are frames."""

from __future__ import annotations

from typing import Protocol

from hilbed.plant import pins
from hilbed.plant.axes.axis import Encoder, Train
from hilbed.types import Nanos


class Answer(Protocol):
    """What the firmware drives at its pins."""

    @property
    def duty(self) -> int: ...

    @property
    def enabled(self) -> bool: ...

    @property
    def speed_ref(self) -> int: ...


class Terminal(Protocol):
    """The other end of a firmware's pins."""

    @property
    def answer(self) -> Answer:
        """The last one; in lockstep to the pins of this tick."""
        ...

    def present(self, counts: int, current: int, supply: int) -> None: ...

    def read(self, inputs: int) -> None:
        """Shows digital inputs that have changed, before the pins of the tick."""
        ...


class EcuAxis:
    """Motor and shaft of a drive that is told what to do from elsewhere."""

    __slots__ = (
        "_encoder", "_terminal", "_train", "coulomb", "current", "duty", "name", "speed_ref",
        "supply_current", "target",
    )  # fmt: skip

    def __init__(self, name: str, train: Train, encoder: Encoder, terminal: Terminal) -> None:
        self.name = name
        self._train = train
        self._encoder = encoder
        self._terminal = terminal
        self.coulomb = train.coulomb
        self.target: float | None = None
        self.current = self.duty = self.speed_ref = self.supply_current = 0.0

    def present(self, angle: float, supply: int) -> None:
        self._terminal.present(self._encoder.sample(angle), pins.current(self._train.current), supply)

    def idle(self, t: Nanos, angle: float, supply: int) -> None:
        """The firmware has had its pins; nothing moves here."""

    def power(self, t: Nanos, on: bool) -> None:
        """Has a supply elsewhere, which no disturbance reaches."""

    def step(self, t: Nanos, angle: float, speed: float, volts: float, supply: int) -> float:  # noqa: ARG002
        train, answer = self._train, self._terminal.answer
        self.duty = pins.duty(answer.duty)
        torque = train.step(self.duty, answer.enabled, volts, speed)
        self.speed_ref = pins.speed(answer.speed_ref)
        self.current = train.current
        self.supply_current = train.supply_current
        return torque
