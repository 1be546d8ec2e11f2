"""The ideal plant: a kinematic robot that does what it is told, but for noise, as the papers simulate it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from hilbed.clock import seconds
from hilbed.plant.kinematics import Integrator, Twist, advanced, exact
from hilbed.ports import Sensor
from hilbed.types import Command, Nanos, Odometry, Pose, Truth


class Vehicle(NamedTuple):
    """What an ideal plant must know of its robot and of the disturbances.

    twist: of a command; limited: a command as the robot takes it; noise: of the command (drawn each period
    and held over it, before the robot's limits) and of the twist; integrator and its sub-steps a period.
    """

    twist: Callable[[Command], Twist]
    limited: Callable[[Command], Command] = lambda command: command
    command_noise: Callable[[Command], Command] = lambda command: command
    twist_noise: Callable[[Twist], Twist] = lambda twist: twist
    integrator: Integrator = exact
    steps: int = 1


class KinematicPlant:
    """A pose that moves with the command held; `obey` takes effect from the next `advance`.

    Sensors see it at the moments at which they are due, also within a period, once `disturb` has told them
    what is wrong with them then.
    """

    def __init__(
        self,
        start: Pose,
        vehicle: Vehicle,
        sensors: Sequence[Sensor] = (),
        disturb: Callable[[Nanos], None] = lambda _: None,
    ) -> None:
        self._pose = start
        self._vehicle = vehicle
        self._sensors = tuple(sensors)
        self._disturb = disturb
        self._command = Command(0.0, 0.0)
        self._t: Nanos = 0

    def truth(self) -> Truth:
        """Returns the pose now."""
        return Truth(self._t, self._pose)

    def start(self) -> None:
        """Lets sensors take their first samples, those at t = 0."""
        self._sample(0, lambda _: self._pose)

    def obey(self, command: Command) -> None:
        """Takes over a command for the coming periods."""
        self._command = command

    def advance(self, start: Nanos, end: Nanos) -> None:
        """Moves over one period; draws the period's noise."""
        of = self._vehicle
        command = of.limited(of.command_noise(self._command))
        twist = of.twist_noise(of.twist(command))

        def pose(t: Nanos) -> Pose:
            return advanced(self._pose, twist, seconds(t - start), of.integrator, of.steps)

        self._sample(end, pose)
        self._pose, self._t = pose(end), end

    def _sample(self, end: Nanos, pose: Callable[[Nanos], Pose]) -> None:
        """Lets sensors that are due up to and including `end` take their samples, in the order of time."""
        while due := [sensor for sensor in self._sensors if sensor.due <= end]:
            sensor = min(due, key=lambda sensor: sensor.due)
            self._disturb(sensor.due)
            sensor.sample(Truth(sensor.due, pose(sensor.due)))


class IdealBase:
    """The robot wired straight to the plant: odometry is the limited command, without the noise on it."""

    def __init__(self, plant: KinematicPlant, vehicle: Vehicle) -> None:
        self._plant = plant
        self._vehicle = vehicle
        self._twist: Twist = (0.0, 0.0)
        self._t: Nanos = 0

    def read(self, t: Nanos) -> Odometry:
        """Returns what encoders that see no noise say of the way since the last call."""
        v, w = self._twist
        T = seconds(t - self._t)
        self._t = t
        return Odometry(t, v * T, w * T, v, w)

    def write(self, t: Nanos, command: Command) -> None:  # noqa: ARG002
        """Passes the command on."""
        self._twist = self._vehicle.twist(self._vehicle.limited(command))
        self._plant.obey(command)
