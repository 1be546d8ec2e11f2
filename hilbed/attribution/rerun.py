"""An estimator once more over the record of a run."""

from __future__ import annotations

from collections import deque

import numpy as np

from hilbed import rng
from hilbed.attribution.evidence import START, Evidence, replaced
from hilbed.build.minds import ESTIMATOR_STREAM, make_estimator
from hilbed.scenario.load import Loaded
from hilbed.types import Array, HilbedError, Odometry, Reading


def rerun(loaded: Loaded, evidence: Evidence, sources: frozenset[str]) -> Array | None:
    """Returns the estimates (N, 3), the named sources replaced by truth; None where they are not finite."""
    known = evidence.known._replace(rng=rng.stream(loaded.scenario.seed, ESTIMATOR_STREAM))
    if START in sources:
        known = known._replace(start=evidence.start)
    estimator = make_estimator(loaded.scenario.estimator, known)
    coming = [deque(readings) for readings in replaced(evidence, sources)]
    rows = evidence.steps.replaced(sources).tolist()
    means = []
    try:
        for t, (sampled, *step) in zip(evidence.times, rows, strict=True):
            odometry = Odometry(round(sampled * 1e9), *step)
            means.append(estimator.step(t, odometry, _due(coming, t)).mean.tolist()[:3])
    except (HilbedError, ArithmeticError, ValueError):  # nothing says that it stands what never happened
        return None
    found = np.array(means)
    return found if np.isfinite(found).all() else None


def _due(coming: list[deque[Reading]], t: int) -> list[Reading]:
    due = []
    for readings in coming:
        while readings and readings[0].delivered <= t:
            due.append(readings.popleft())
    return due
