"""The simulated far end: drives on the bus, their shafts and the world, tick by tick."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Collection, Sequence
from typing import Protocol, TypeAlias, cast

import numpy as np

from firmware_sim import Drive
from hilbed.cost import Cost, perf_counter
from hilbed.effects import Effects
from hilbed.plant import pins
from hilbed.ports import Bus, Sensor
from hilbed.types import Array, Frame, Nanos, Pose, Truth

SIGNALS = ("speed", "current", "slip", "load_torque", "torque", "speed_ref", "duty")
"""What a row of the tick log holds, each of all drives in their order; units as in signals.npz."""


class World(Protocol):
    """Moves the robot by the torques at its wheels; lists are in the order of the drives."""

    angles: list[float]
    speeds: list[float]
    slips: list[float]

    @property
    def pose(self) -> Pose: ...

    @property
    def wheels(self) -> Sequence[tuple[float, float]]: ...

    def step(self, torques: Sequence[float], coulomb: Sequence[float], effects: Effects) -> None: ...


class Schedule(Protocol):
    """Brings the effects of the disturbances up to date."""

    effects: Effects

    def apply(self, t: Nanos, surroundings: World) -> None: ...


class Medium(Protocol):
    """A bus in simulated time."""

    def advance(self, until: Nanos) -> None: ...


class Train(Protocol):
    """Chopper, motor and gear of one wheel; `coulomb` is the dry friction (N m) the world lets act."""

    coulomb: float
    current: float
    supply_current: float

    def step(self, duty: float, enabled: bool, supply: float, wheel_speed: float) -> float: ...


class Encoder(Protocol):
    def sample(self, angle: float) -> int: ...


class Supply(Protocol):
    def voltage(self, current: float, drop: float) -> float: ...


class Port(Bus, Protocol):
    """A node's CAN controller, whose acceptance filter the firmware sets."""

    def accept(self, identifiers: Collection[int]) -> None: ...


Attach: TypeAlias = Callable[[str], Port]
"""Puts a node on the bus, by name."""


class Axis:
    """One drive from its node on the bus to its shaft.

    Its firmware is one loop of a kilohertz: at the start of a tick it heeds the frames that have come since
    the last one, then it reads its pins.
    """

    __slots__ = ("_outbox", "encoder", "firmware", "name", "port", "train")

    def __init__(self, name: str, node: int, train: Train, encoder: Encoder, attach: Attach) -> None:
        self.name = name
        self.port = attach(name)
        self.firmware = Drive(node, self.port.accept)
        self._outbox = cast("list[Frame]", self.firmware.outbox)  # frames with the same fields
        self.train = train
        self.encoder = encoder

    def tick(self, t: Nanos, angle: float, current: int, supply: int) -> int:
        """Runs the firmware's tick at `t` and returns the duty in Q15; angle: rad, of the wheel."""
        firmware, port, outbox = self.firmware, self.port, self._outbox
        for _, frame in port.recv(t):
            firmware.on_frame(t, frame)
        duty = firmware.tick(t, self.encoder.sample(angle), current, supply)
        if outbox:
            for frame in outbox:
                port.send(t, frame)
            outbox.clear()
        return duty


class SimulatedPlant:
    """Drives, shafts, world and wire on the physics clock; `tick` in ns.

    In each tick the firmware reads its pins and sets a duty, chopper and motor turn it into torque, the
    world takes a step, the bus delivers what arrives meanwhile, and sensors that are due take a sample.
    """

    def __init__(
        self,
        axes: Sequence[Axis],
        world: World,
        supply: Supply,
        schedule: Schedule,
        wire: Medium,
        sensors: Sequence[Sensor],
        tick: Nanos,
        cost: Cost,
    ) -> None:
        self._axes = tuple(axes)
        self._world = world
        self._supply = supply
        self._schedule = schedule
        self._wire = wire
        self._sensors = tuple(sensors)
        self._tick = tick
        self._cost = cost
        self._now: Nanos = 0
        self._drawn = 0.0  # A out of the supply, over the last tick
        self._log = array("d")
        self._coulomb = [axis.train.coulomb for axis in self._axes]

    def truth(self) -> Truth:
        """Returns where the robot is now."""
        return Truth(self._now, self._world.pose)

    def idle(self, start: Nanos, end: Nanos) -> None:
        """Runs firmware and bus with the shafts at rest, as while the drives are booted."""
        volts = pins.supply(self._supply.voltage(0.0, 0.0))
        for t in range(start, end, self._tick):
            for axis, angle in zip(self._axes, self._world.angles, strict=True):
                axis.tick(t, angle, 0, volts)
            self._wire.advance(t + self._tick)

    def start(self) -> None:
        """Takes the state at t = 0 into the log and the sensors' first samples."""
        self._schedule.apply(0, self._world)
        nothing = [0.0] * len(self._axes)
        loads = self._schedule.effects.load_torque
        self._log.extend((*self._world.speeds, *nothing, *nothing, *loads, *nothing, *nothing, *nothing))
        for sensor in self._sensors:
            if sensor.due <= 0:
                sensor.sample(self.truth())

    def advance(self, start: Nanos, end: Nanos) -> None:
        """Moves everything from `start` to `end`; Diverged if the world does not stand that."""
        for t in range(start, end, self._tick):
            self._step(t)
            self._now = now = t + self._tick
            for sensor in self._sensors:
                if sensor.due <= now:
                    self._schedule.apply(now, self._world)  # a frame sees what begins with it
                    sensor.sample(self.truth())

    def _step(self, t: Nanos) -> None:
        cost, world, schedule = self._cost, self._world, self._schedule
        effects = schedule.effects
        begun = perf_counter()
        schedule.apply(t, world)
        volts = self._supply.voltage(self._drawn, effects.supply_drop)
        volts_pin = pins.supply(volts)
        torques, duties, currents, references, drawn = [], [], [], [], 0.0
        for axis, angle, speed in zip(self._axes, world.angles, world.speeds, strict=True):
            firmware, train = axis.firmware, axis.train
            duty = pins.duty(axis.tick(t, angle, pins.current(train.current), volts_pin))
            torques.append(train.step(duty, firmware.bridge_enabled, volts, speed))
            duties.append(duty)
            currents.append(train.current)
            references.append(firmware.speed_ref)
            drawn += train.supply_current
        self._drawn = drawn
        driven = perf_counter()
        self._wire.advance(t + self._tick)
        carried = perf_counter()
        cost.drives += driven - begun
        cost.bus += carried - driven
        world.step(torques, self._coulomb, effects)
        self._log.extend(
            (*world.speeds, *currents, *world.slips, *effects.load_torque, *torques, *references, *duties)
        )

    def ticks(self, first: int = 0) -> dict[str, Array]:
        """Returns the tick log from row `first` on: "tick/t" and "tick/drive/NAME/…", each (M,)."""
        width = len(SIGNALS) * len(self._axes)
        rows = np.array(self._log[first * width :]).reshape(-1, width)
        stamps = np.arange(first, first + len(rows), dtype=np.float64) * (self._tick * 1e-9)
        columns: dict[str, Array] = {"tick/t": stamps}
        for k, axis in enumerate(self._axes):
            for j, signal in enumerate(SIGNALS):
                columns[f"tick/drive/{axis.name}/{signal}"] = rows[:, j * len(self._axes) + k].copy()
        return columns
