"""The controller's side of the bench, with a record in place of drives, sensors and world."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from math import nan

from hilbed.build.known import nodes_of, start_of, surroundings, told_of
from hilbed.build.minds import Guidance, make_controller, make_estimator
from hilbed.build.upsets import Nowhere, effects_of, schedule_of
from hilbed.can.base import CanBase
from hilbed.clock import NEVER, nanos
from hilbed.cost import Cost
from hilbed.disturbances.commands import DisturbedBase
from hilbed.effects import Effects
from hilbed.loop import Rig
from hilbed.plant.specs import SimulatedSpec
from hilbed.ports import Reference
from hilbed.record.readings import kinds, readings
from hilbed.replay.recording import Recording
from hilbed.robots import ROBOTS
from hilbed.types import Frame, Nanos, Pose, Reading, Received, ScenarioError, Truth


class RecordedBus:
    """Hands out recorded frames at their times; what is sent goes nowhere."""

    def __init__(self, frames: Iterable[Received]) -> None:
        self._coming = deque(frames)

    def send(self, t: Nanos, frame: Frame) -> None:
        """Drops the frame: the drives have answered already."""

    def recv(self, t: Nanos) -> list[Received]:
        """Returns what had arrived up to and including `t` since the last call."""
        coming, arrived = self._coming, []
        while coming and coming[0].t <= t:
            arrived.append(coming.popleft())
        return arrived


class RecordedSensor:
    """Hands out recorded readings when they were delivered."""

    due: Nanos = NEVER  # there is no world to be sampled

    def __init__(self, recorded: Iterable[Reading]) -> None:
        self._coming = deque(recorded)

    def sample(self, truth: Truth) -> None:
        """Does nothing."""

    def read(self, t: Nanos) -> list[Reading]:
        """Returns what was delivered up to and including `t` since the last call."""
        coming, arrived = self._coming, []
        while coming and coming[0].delivered <= t:
            arrived.append(coming.popleft())
        return arrived


class NoPlant:
    """Nothing moves, and nobody knows the truth."""

    def truth(self) -> Truth:
        """Returns an unknown pose."""
        return Truth(0, Pose(nan, nan, nan))

    def advance(self, start: Nanos, end: Nanos) -> None:
        """Does nothing."""


def rig_of(recording: Recording) -> tuple[Rig, Pose, Reference | None]:
    """Returns the rig of a recorded run, where it starts, and its reference; raises ScenarioError."""
    scenario, spec = recording.loaded.scenario, recording.loaded.scenario.plant
    if not isinstance(spec, SimulatedSpec):
        raise ScenarioError(f"a run of plant {spec.kind} has no drives on a bus to be replayed")
    robot = ROBOTS[scenario.robot.kind](scenario.robot)
    reference = None if scenario.reference is None else scenario.reference.build()
    start, period = told_of(scenario, start_of(scenario, reference)), nanos(scenario.period)
    nodes = nodes_of(scenario, spec, robot.drives)
    sensors = tuple(RecordedSensor(readings(recording.signals, kind)) for kind in kinds(recording.signals))
    base = CanBase(robot, RecordedBus(recording.frames), nodes, scenario.bus)
    upsets = schedule_of(scenario, robot.drives, Effects(()), ("command_noise",))  # the rest is in the record
    rig = Rig(
        DisturbedBase(base, robot.limited, effects_of(upsets, Nowhere())),
        sensors,
        make_estimator(scenario.estimator, surroundings(scenario, spec.beacons, start)),
        make_controller(scenario.controller, Guidance(reference, period, robot)),
        NoPlant(),
        period,
        Cost(),
    )
    return rig, start, reference
