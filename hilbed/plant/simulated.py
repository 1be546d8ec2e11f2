"""The simulated far end: drives on the bus, their shafts and the world, tick by tick."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Sequence
from typing import Protocol, TypeAlias

import numpy as np

from hilbed.clock import NEVER
from hilbed.cost import Cost, perf_counter
from hilbed.effects import Effects
from hilbed.plant import pins
from hilbed.plant.axes import Axis
from hilbed.plant.specs import STEERING
from hilbed.ports import Sensor
from hilbed.types import Array, Nanos, Pose, Truth

SIGNALS = ("speed", "current", "slip", "load_torque", "torque", "speed_ref", "duty")
"""What a row of the tick log holds, each of all drives in their order; units as in signals.npz.

speed, current and slip are states at the row's t; torque is the mean over the tick that ends there, and
load_torque, speed_ref and duty are what has been held during it: what begins at t is in the next row.
"""


class World(Protocol):
    """Moves the robot by the torques at its wheels; lists are in the order of the drives.

    targets: speeds (rad/s) towards which the `coulomb` torque of a step pulls the wheels; zeros: friction.
    """

    targets: list[float]
    angles: list[float]
    speeds: list[float]
    slips: list[float]

    @property
    def pose(self) -> Pose: ...

    @property
    def wheels(self) -> Sequence[tuple[float, float]]: ...

    def begin(self) -> None: ...

    def step(self, torques: Sequence[float], coulomb: Sequence[float], effects: Effects) -> None: ...


class Schedule(Protocol):
    """Brings the effects of the disturbances up to date."""

    effects: Effects

    def apply(self, t: Nanos, surroundings: World) -> None: ...


class Medium(Protocol):
    """A bus in simulated time."""

    def advance(self, until: Nanos) -> None: ...


class Supply(Protocol):
    def voltage(self, current: float, drop: float) -> float: ...


Collect: TypeAlias = Callable[[Nanos], None]
"""Waits for the answers of all firmware that is elsewhere to the pins that it has been shown."""


class SimulatedPlant:
    """Drives, shafts, world and wire on the physics clock; `tick` in ns.

    In each tick firmware reads its pins and sets a duty, chopper and motor turn it into torque, the world
    takes a step, the bus delivers what arrives meanwhile, and sensors that are due take a sample.
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
        collect: Collect | None = None,
    ) -> None:
        """collect: where some firmware is elsewhere; called in every tick when all pins have been shown."""
        self._axes = tuple(axes)
        self._world = world
        self._supply = supply
        self._schedule = schedule
        self._wire = wire
        self._sensors = tuple(sensors)
        self._tick = tick
        self._cost = cost
        self._now: Nanos = 0
        self._due: Nanos = 0  # when the next sensor takes a sample
        self._drawn = 0.0  # A out of the supply, over the last tick
        self._log = array("d")
        self._steering = next((k for k, axis in enumerate(self._axes) if axis.name == STEERING), None)
        self._angles = array("d")  # of the steering axis, a row a tick
        self._coulomb = [axis.coulomb for axis in self._axes]
        self._led = [(k, axis) for k, axis in enumerate(self._axes) if axis.target is not None]
        self._collect = collect

    def truth(self) -> Truth:
        """Returns where the robot is now."""
        return Truth(self._now, self._world.pose)

    def idle(self, start: Nanos, end: Nanos) -> None:
        """Runs firmware and bus with the shafts at rest, as while the drives are booted."""
        volts = pins.supply(self._supply.voltage(0.0, 0.0))
        for t in range(start, end, self._tick):
            self._present(t, volts)
            for axis, angle in zip(self._axes, self._world.angles, strict=True):
                axis.idle(t, angle, volts)
            self._wire.advance(t + self._tick)

    def live(self, start: Nanos, end: Nanos) -> None:
        """Runs everything off the record, as while a drive looks for its home before t = 0."""
        cost = self._cost
        booked = cost.drives, cost.bus, cost.physics
        for t in range(start, end, self._tick):
            self._step(t)
        del self._log[:], self._angles[:]
        cost.drives, cost.bus, cost.physics = booked

    def start(self) -> None:
        """Takes the state at t = 0 into the log and the sensors' first samples."""
        self._world.begin()
        self._schedule.apply(0, self._world)
        nothing = [0.0] * len(self._axes)
        loads = self._schedule.effects.load_torque
        self._log.extend((*self._world.speeds, *nothing, *nothing, *loads, *nothing, *nothing, *nothing))
        if self._steering is not None:
            self._angles.append(self._world.angles[self._steering])
        self._sample(0)

    def advance(self, start: Nanos, end: Nanos) -> None:
        """Moves everything from `start` to `end`; Diverged if the world does not stand that."""
        for t in range(start, end, self._tick):
            self._step(t)
            self._now = now = t + self._tick
            if now >= self._due:
                self._schedule.apply(now, self._world)  # a frame sees what begins with it
                self._sample(now)

    def _sample(self, now: Nanos) -> None:
        """Has the sensors that are due take a sample, and finds out when the next one is."""
        for sensor in self._sensors:
            if sensor.due <= now:
                sensor.sample(self.truth())
        self._due = min((sensor.due for sensor in self._sensors), default=NEVER)

    def _step(self, t: Nanos) -> None:
        cost, world, schedule = self._cost, self._world, self._schedule
        effects = schedule.effects
        begun = perf_counter()
        schedule.apply(t, world)
        volts = self._supply.voltage(self._drawn, effects.supply_drop)
        volts_pin = pins.supply(volts)
        self._present(t, volts_pin)
        torques, duties, currents, references, drawn = [], [], [], [], 0.0
        for axis, angle, speed in zip(self._axes, world.angles, world.speeds, strict=True):
            torques.append(axis.step(t, angle, speed, volts, volts_pin))
            duties.append(axis.duty)
            currents.append(axis.current)
            references.append(axis.speed_ref)
            drawn += axis.supply_current
        self._drawn = drawn
        driven = perf_counter()
        self._wire.advance(t + self._tick)
        carried = perf_counter()
        cost.drives += driven - begun
        cost.bus += carried - driven
        for k, axis in self._led:
            world.targets[k] = axis.target or 0.0
        world.step(torques, self._coulomb, effects)
        self._log.extend(
            (*world.speeds, *currents, *world.slips, *effects.load_torque, *torques, *references, *duties)
        )
        if self._steering is not None:
            self._angles.append(world.angles[self._steering])

    def _present(self, t: Nanos, volts: int) -> None:
        """Shows all pins at once to what firmware is elsewhere, so that it works side by side."""
        if self._collect is not None:
            for axis, angle in zip(self._axes, self._world.angles, strict=True):
                axis.present(angle, volts)
            self._collect(t)

    def ticks(self, first: int = 0) -> dict[str, Array]:
        """Returns the tick log from row `first` on: "tick/t" and "tick/drive/NAME/…", each (M,)."""
        width = len(SIGNALS) * len(self._axes)
        rows = np.array(self._log[first * width :]).reshape(-1, width)
        stamps = np.arange(first, first + len(rows), dtype=np.float64) * (self._tick * 1e-9)
        columns: dict[str, Array] = {"tick/t": stamps}
        for k, axis in enumerate(self._axes):
            for j, signal in enumerate(SIGNALS):
                columns[f"tick/drive/{axis.name}/{signal}"] = rows[:, j * len(self._axes) + k].copy()
        if self._steering is not None:
            columns[f"tick/drive/{STEERING}/angle"] = np.array(self._angles[first:])
        return columns
