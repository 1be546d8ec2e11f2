"""The bench on one screen: a rig, its control cycle and its run."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import isfinite

from hilbed.clock import seconds
from hilbed.cost import Cost, perf_counter
from hilbed.ports import Base, Controller, Estimator, Plant, Sensor
from hilbed.types import Cycle, Diverged, Estimate, Nanos


@dataclass(frozen=True)
class Rig:
    """Everything one run needs, each part behind its seam; `period` is that of the control cycle."""

    base: Base
    sensors: tuple[Sensor, ...]
    estimator: Estimator
    controller: Controller
    plant: Plant
    period: Nanos
    cost: Cost


def sound(estimate: Estimate) -> bool:
    """Tells whether mean and covariance are numbers; a covariance that is NaN throughout is none at all."""
    doubt = estimate.covariance.tolist()
    mean = sum(estimate.mean.tolist())
    return isfinite(mean + sum(map(sum, doubt))) or (
        isfinite(mean) and all(element != element for row in doubt for element in row)
    )


def think(rig: Rig, t: Nanos) -> Cycle:
    """Reads the robot and its sensors at `t` and decides what to do, without doing it.

    Raises Diverged where the estimator has lost its numbers.
    """
    truth = rig.plant.truth()
    start = perf_counter()
    odometry = rig.base.read(t)
    rig.cost.bus += perf_counter() - start
    readings = [reading for sensor in rig.sensors for reading in sensor.read(t)]
    start = perf_counter()
    estimate = rig.estimator.step(t, odometry, readings)
    if not sound(estimate):
        raise Diverged(f"t = {seconds(t):.3f} s: the estimate is not finite ({estimate.mean.tolist()})")
    thought = perf_counter()
    command = rig.controller.step(t, estimate)
    rig.cost.controller += perf_counter() - thought
    rig.cost.estimator += thought - start
    return Cycle(t, truth, odometry, readings, estimate, command)


def cycle(rig: Rig, t: Nanos, act: bool = True) -> Cycle:
    """Runs the control period that starts at `t`: read, think, write, let the world move.

    act: whether the commands are written; those of a cycle that comes too late are not.
    """
    thought = think(rig, t)
    if act:
        start = perf_counter()
        rig.base.write(t, thought.command)
        rig.cost.bus += perf_counter() - start
    rig.plant.advance(t, t + rig.period)
    return thought


def at_once(_: Nanos) -> bool:
    """The pace of a run in simulated time: every cycle may begin, and is in time."""
    return True


def run(rig: Rig, duration: Nanos, pace: Callable[[Nanos], bool] = at_once) -> Iterator[Cycle]:
    """Yields the cycles of a run, and last what is known and decided at its very end.

    duration: ns, a multiple of the period. Yields duration / period + 1 cycles; the last one moves nothing.
    pace: waits for a cycle's beginning; returns whether its commands may still be written.
    """
    for t in range(0, duration, rig.period):
        yield cycle(rig, t, pace(t))
    pace(duration)
    yield think(rig, duration)
