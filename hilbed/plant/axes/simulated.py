"""A drive in this process: the firmware is a node on the wire, its motor and shaft are here."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Protocol, TypeAlias, cast

from firmware_sim import Drive
from firmware_sim.terminal import micro
from hilbed.plant import pins
from hilbed.plant.axes.axis import Encoder, Train
from hilbed.ports import Bus
from hilbed.types import Frame, Nanos


class Port(Bus, Protocol):
    """A node's CAN controller, whose acceptance filter the firmware sets."""

    def accept(self, identifiers: Collection[int]) -> None: ...

    def unplug(self, t: Nanos) -> None: ...

    def plug(self, t: Nanos) -> None: ...


class Firmware(Protocol):
    """What a microcontroller runs: frames in, ticks, frames out; pins as `firmware_sim.Drive` has them."""

    @property
    def outbox(self) -> list[Frame]: ...

    @property
    def bridge_enabled(self) -> bool: ...

    @property
    def speed_ref(self) -> float: ...

    def on_frame(self, t: Nanos, frame: Frame) -> None: ...

    def read(self, inputs: int) -> None: ...

    def tick(self, t: Nanos, counts: int, current: int, supply: int) -> int: ...


Accept: TypeAlias = Callable[[Collection[int]], None]
Make: TypeAlias = Callable[[Accept], Firmware]
Attach: TypeAlias = Callable[[str], Port]
"""Puts a node on the bus, by name."""


def own_firmware(node: int) -> Make:
    """Returns what makes the bench's own drive, by its node number."""
    return lambda accept: cast("Firmware", Drive(node, accept))  # its frames have the same fields


class Unpowered:
    """Firmware whose logic has no supply: it hears and says nothing, and the bridge is open."""

    bridge_enabled = False
    speed_ref = 0.0

    def __init__(self) -> None:
        self.outbox: list[Frame] = []

    def on_frame(self, t: Nanos, frame: Frame) -> None:
        """Takes a frame."""

    def read(self, inputs: int) -> None:
        """Takes digital inputs."""

    def tick(self, t: Nanos, counts: int, current: int, supply: int) -> int:  # noqa: ARG002
        return 0


class SimulatedAxis:
    """One drive from its node on the bus to its shaft.

    Its firmware is one loop of a kilohertz: at the start of a tick it heeds the frames that have come since
    the last one, then it reads its pins.
    """

    __slots__ = (
        "_followed", "_make", "_outbox", "coulomb", "current", "duty", "encoder", "firmware", "name", "port",
        "speed_ref", "supply_current", "target", "train",
    )  # fmt: skip

    def __init__(self, name: str, make: Make, train: Train, encoder: Encoder, attach: Attach) -> None:
        """make: makes the firmware, at first and when power comes back; told how to set the filter."""
        self.name = name
        self.port = attach(name)
        self._make = make
        self.firmware: Firmware = make(self.port.accept)
        self._outbox = self.firmware.outbox
        self.train = train
        self.encoder = encoder
        self.coulomb = train.coulomb
        self.target: float | None = None
        self.current = self.duty = self.speed_ref = self.supply_current = 0.0
        self._followed = 0.0  # what the firmware's reference was when `speed_ref` was made of it

    def present(self, angle: float, supply: int) -> None:
        """Has its firmware here, which reads its pins in the tick itself."""

    def idle(self, t: Nanos, angle: float, supply: int) -> None:
        self._tick(t, angle, 0, supply)

    def power(self, t: Nanos, on: bool) -> None:
        if on is not isinstance(self.firmware, Unpowered):
            return
        (self.port.plug if on else self.port.unplug)(t)
        self.firmware = self._make(self.port.accept) if on else Unpowered()
        self._outbox = self.firmware.outbox

    def step(self, t: Nanos, angle: float, speed: float, volts: float, supply: int) -> float:
        train, firmware = self.train, self.firmware
        duty = pins.duty(self._tick(t, angle, pins.current(train.current), supply))
        torque = train.step(duty, firmware.bridge_enabled, volts, speed)
        self.duty = duty
        if firmware.speed_ref != self._followed:
            self._followed = firmware.speed_ref
            self.speed_ref = pins.speed(micro(self._followed))
        self.current = train.current
        self.supply_current = train.supply_current
        return torque

    def _tick(self, t: Nanos, angle: float, current: int, supply: int) -> int:
        """Runs the firmware's tick at `t` and returns the duty in Q15."""
        firmware, port, outbox = self.firmware, self.port, self._outbox
        for _, frame in port.recv(t):
            firmware.on_frame(t, frame)
        duty = firmware.tick(t, self.encoder.sample(angle), current, supply)
        if outbox:
            for frame in outbox:
                port.send(t, frame)
            outbox.clear()
        return duty
