"""The disturbances of a scenario, ready to act."""

from __future__ import annotations

from collections.abc import Sequence

from hilbed import rng
from hilbed.disturbances import DISTURBANCES
from hilbed.disturbances.schedule import Schedule
from hilbed.effects import Effects
from hilbed.scenario.model import Scenario


def schedule_of(scenario: Scenario, drives: Sequence[str], effects: Effects) -> Schedule:
    """Returns what writes the effects, each disturbance with randomness of its own."""
    entries = []
    for k, spec in enumerate(scenario.disturbances):
        drive = getattr(spec, "drive", None)
        wheel = -1 if drive is None else drives.index(drive)
        own = rng.stream(scenario.seed, f"disturbances.{k}")
        entries.append((spec, DISTURBANCES[spec.kind](spec, wheel, own)))
    return Schedule(entries, effects)
