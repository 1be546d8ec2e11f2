"""A drive on a desk: firmware, chopper, motor, gear, encoder, supply and what its shaft turns."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import cast

from firmware_sim import Drive
from hilbed.clock import MILLISECOND
from hilbed.drive.shaft import Shaft
from hilbed.plant import pins
from hilbed.plant.axes import HomeSwitch
from hilbed.plant.chopper import Averaged
from hilbed.plant.drivetrain import DriveTrain, reflected_inertia
from hilbed.plant.encoder import Encoder, EncoderSpec
from hilbed.plant.gear import GEARS, GearSpec
from hilbed.plant.motor import MOTORS, MotorSpec
from hilbed.plant.supply import Supply, SupplySpec
from hilbed.types import Frame, Nanos

TICK: Nanos = MILLISECOND
DEFAULT_COUNTS = 66_000
_DT = 1e-3
_IN_COUNTS = {0x607F: 210_000, 0x6083: 105_000, 0x6084: 105_000, 0x6085: 525_000}
"""Highest speed and ramps for an encoder of so many counts a turn."""


@dataclass(frozen=True)
class Build:
    """What a drive is made of.

    inertia: kg m² at the wheel, rotor and gear come on top; load: N m at the wheel against forward rotation;
    friction: N m at the wheel, dry, besides the motor's own; counts: of the encoder, a turn of the wheel;
    supply: V, open circuit; angle: rad, where the shaft stands at first; switch: rad, from which angle on its
    home switch is on, None for none.
    """

    node: int
    motor: MotorSpec = MOTORS["re35"]
    gear: GearSpec = GEARS["gp32c-33"]
    inertia: float = 0.05
    load: float = 0.0
    friction: float = 0.0
    counts: int = DEFAULT_COUNTS
    supply: float = 24.0
    angle: float = 0.0
    switch: float | None = None


class Desk:
    """One drive, tick by tick; `shaft` is what its encoder sees, `current` that of its motor (A)."""

    def __init__(self, build: Build) -> None:
        inertia = build.inertia + reflected_inertia(build.motor, build.gear)
        self.firmware = Drive(build.node, stored=_plate(build))
        self._train = DriveTrain(build.motor, build.gear, Averaged(), _DT, inertia)
        self.shaft = Shaft(inertia, build.load, build.friction + self._train.coulomb, _DT)
        self.shaft.angle = build.angle
        self._switch = None if build.switch is None else HomeSwitch(build.switch)
        self._inputs = 0
        self._encoder = Encoder(EncoderSpec(resolution=build.counts), _DT)
        self._supply = Supply(SupplySpec(voltage=build.supply))

    @property
    def current(self) -> float:
        return self._train.current

    def tick(self, t: Nanos, frames: Iterable[Frame]) -> list[Frame]:
        """Heeds the frames that have come, runs the tick at `t` and returns the frames to send."""
        firmware, train, shaft = self.firmware, self._train, self.shaft
        for frame in frames:
            firmware.on_frame(t, frame)
        if self._switch is not None:
            self._read(self._switch.inputs(shaft.angle))
        volts = self._supply.voltage(train.supply_current, 0.0)
        counts = self._encoder.sample(shaft.angle)
        duty = firmware.tick(t, counts, pins.current(train.current), pins.supply(volts))
        shaft.step(train.step(pins.duty(duty), firmware.bridge_enabled, volts, shaft.speed))
        sent = cast("list[Frame]", [*firmware.outbox])  # frames with the same fields
        firmware.outbox.clear()
        return sent

    def _read(self, inputs: int) -> None:
        if inputs != self._inputs:
            self._inputs = inputs
            self.firmware.read(inputs)


def _plate(build: Build) -> dict[tuple[int, int], float]:
    """Returns what its maker has stored of motor and encoder, by index and sub-index.

    Speeds and accelerations are in counts, so that another encoder would change what they mean.
    """
    motor, emf, scale = build.motor, build.motor.back_emf * build.gear.ratio, build.counts / DEFAULT_COUNTS
    return {
        (0x2001, 0): build.counts,
        (0x2012, 1): motor.resistance,
        (0x2012, 2): emf,
        (0x2013, 1): min(motor.max_current, 32.0),
        (0x6075, 0): max(1, round(1e3 * motor.nominal_current)),  # mA
        (0x6076, 0): max(1, round(1e3 * motor.nominal_current * motor.torque_constant * build.gear.ratio)),
        **{(index, 0): max(1, round(scale * value)) for index, value in _IN_COUNTS.items()},
    }
