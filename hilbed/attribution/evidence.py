"""What a run has recorded of an estimator's inputs, and what each of them would have been without a fault."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from hilbed.attribution.wheels import Steps, steps_of
from hilbed.build.known import start_of, surroundings, told_of
from hilbed.build.minds import Surroundings
from hilbed.build.recorded import known_of
from hilbed.record.readings import Signals, kinds, numbers_of, readings
from hilbed.scenario.load import Loaded
from hilbed.types import Pose, Reading

ASSOCIATION, LATENESS, START = "association", "late measurements", "start"
SPURIOUS = -1
NOWHERE_ELSE = 1e-9  # m or rad


class Witnessed(NamedTuple):
    """A reading, the truth that it should have told (NaN: none), and the beacon that it truly showed."""

    reading: Reading
    true: tuple[float, ...]
    beacon: int


class Evidence(NamedTuple):
    """What an estimator is given: row times (ns), odometry, readings by kind, what it knows from the start.

    start: where the robot truly was; sources: names of what differs from truth here and can be replaced.
    """

    times: list[int]
    steps: Steps
    readings: dict[str, list[Witnessed]]
    known: Surroundings
    start: Pose
    sources: tuple[str, ...]


def evidence_of(loaded: Loaded, signals: Signals) -> Evidence:
    """Reads what an estimator was given from a run's signals; ScenarioError where columns are missing."""
    known = KNOWN.get(loaded.scenario.plant.kind, _simulated)(loaded)
    start = Pose(*signals["truth"][0].tolist())
    steps = steps_of(loaded.scenario.robot, signals)
    witnessed = {kind: _witnessed(signals, kind) for kind in kinds(signals)}
    found = [*steps.sources]
    sensors = [f"{kind} error" for kind in witnessed] + [ASSOCIATION, LATENESS]
    found += [source for source in sensors if _differs(witnessed, source)]
    if np.abs(np.subtract(known.start, start)).max() > NOWHERE_ELSE:
        found.append(START)
    times = np.rint(signals["t"] * 1e9).astype(np.int64).tolist()
    return Evidence(times, steps, witnessed, known, start, tuple(found))


def _simulated(loaded: Loaded) -> Surroundings:
    scenario = loaded.scenario
    reference = None if scenario.reference is None else scenario.reference.build()
    told = told_of(scenario, start_of(scenario, reference))
    return surroundings(scenario, list(getattr(scenario.plant, "beacons", ())), told)


KNOWN: dict[str, Callable[[Loaded], Surroundings]] = {"recorded": known_of}
"""By the kind of plant, where the scenario does not say it all."""


def replaced(evidence: Evidence, sources: frozenset[str]) -> list[list[Reading]]:
    """Returns the readings of each kind, in the order of delivery, the named sources replaced by truth."""
    return [
        sorted(
            (made for one in all_of if (made := _true(one, kind, sources)) is not None),
            key=lambda reading: reading.delivered,
        )
        for kind, all_of in evidence.readings.items()
    ]


def _differs(witnessed: dict[str, list[Witnessed]], source: str) -> bool:
    sources = frozenset((source,))
    return any(
        _true(one, kind, sources) != one.reading for kind, all_of in witnessed.items() for one in all_of
    )


def _true(one: Witnessed, kind: str, sources: frozenset[str]) -> Reading | None:
    """Returns a reading with the sources replaced; None for a spurious one where association is."""
    reading = one.reading
    if ASSOCIATION in sources:
        if one.beacon == SPURIOUS and not np.isfinite(one.true).all():
            return None
        reading = reading._replace(beacon=None if one.beacon == SPURIOUS else one.beacon)
    if f"{kind} error" in sources and np.isfinite(one.true).all():
        reading = reading._replace(value=one.true)
    if LATENESS in sources:
        reading = reading._replace(delivered=reading.t)
    return reading


def _witnessed(signals: Signals, kind: str) -> list[Witnessed]:
    true = numbers_of(signals[f"{kind}/true"])
    shown = signals[f"{kind}/beacon"].tolist()
    told = readings(signals, kind)
    return [Witnessed(reading, t, b) for reading, t, b in zip(told, true, shown, strict=True)]
