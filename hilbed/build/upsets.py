"""The disturbances of a scenario, ready to act."""

from __future__ import annotations

from collections.abc import Callable, Container, Sequence
from math import nan

from hilbed import rng
from hilbed.disturbances import DISTURBANCES
from hilbed.disturbances.schedule import Schedule
from hilbed.effects import Effects, Surroundings
from hilbed.scenario.model import Scenario
from hilbed.types import Nanos, Pose


class Nowhere:
    """The surroundings of disturbances that only know the time."""

    pose = Pose(nan, nan, nan)
    wheels: Sequence[tuple[float, float]] = ()


def schedule_of(
    scenario: Scenario, drives: Sequence[str], effects: Effects, kinds: Container[str] = DISTURBANCES
) -> Schedule:
    """Returns what writes the effects of some kinds of disturbances, each with randomness of its own."""
    entries = []
    for k, spec in enumerate(scenario.disturbances):
        if spec.kind in kinds:
            drive = getattr(spec, "drive", None)
            wheel = -1 if drive is None else drives.index(drive)
            own = rng.stream(scenario.seed, f"disturbances.{k}")
            entries.append((spec, DISTURBANCES[spec.kind](spec, wheel, own)))
    return Schedule(entries, effects)


def effects_of(schedule: Schedule, place: Surroundings) -> Callable[[Nanos], Effects]:
    """Returns what brings the effects up to date and gives them."""

    def effects(t: Nanos) -> Effects:
        schedule.apply(t, place)
        return schedule.effects

    return effects
