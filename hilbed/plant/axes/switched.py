"""A steering axis with a home switch."""

from __future__ import annotations

from hilbed.plant.axes.axis import Encoder, Train
from hilbed.plant.axes.ecu import EcuAxis, Terminal
from hilbed.plant.axes.simulated import Attach, Make, SimulatedAxis
from hilbed.types import Nanos

HOME = 4
"""Of the digital inputs (60FD)."""


class HomeSwitch:
    """On from an angle (rad, of the axis) on; sign: -1 where the shaft turns the other way."""

    def __init__(self, angle: float, sign: int = 1) -> None:
        self._angle = angle
        self._sign = sign

    def inputs(self, shaft: float) -> int:
        """Returns the digital inputs at an angle (rad) of the shaft."""
        return HOME if self._sign * shaft >= self._angle else 0


class SwitchedAxis(SimulatedAxis):
    """A drive in this process that reads a switch."""

    __slots__ = ("_inputs", "_switch")

    def __init__(
        self, name: str, make: Make, train: Train, encoder: Encoder, attach: Attach, switch: HomeSwitch
    ) -> None:
        super().__init__(name, make, train, encoder, attach)
        self._switch = switch
        self._inputs: int | None = None  # as the firmware has read them

    def power(self, t: Nanos, on: bool) -> None:
        before = self.firmware
        super().power(t, on)
        if self.firmware is not before:
            self._inputs = None

    def _tick(self, t: Nanos, angle: float, current: int, supply: int) -> int:
        inputs = self._switch.inputs(angle)
        if inputs != self._inputs:
            self._inputs = inputs
            self.firmware.read(inputs)
        return super()._tick(t, angle, current, supply)


class SwitchedEcuAxis(EcuAxis):
    """A drive whose firmware is elsewhere and is told of a switch here."""

    __slots__ = ("_inputs", "_pins", "_switch")

    def __init__(
        self, name: str, train: Train, encoder: Encoder, terminal: Terminal, switch: HomeSwitch
    ) -> None:
        super().__init__(name, train, encoder, terminal)
        self._pins = terminal
        self._switch = switch
        self._inputs = 0  # of firmware that has just been powered

    def present(self, angle: float, supply: int) -> None:
        inputs = self._switch.inputs(angle)
        if inputs != self._inputs:
            self._inputs = inputs
            self._pins.read(inputs)
        super().present(angle, supply)
