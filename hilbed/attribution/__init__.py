"""What the pose error is made of: the estimator runs again over a run's record, sources replaced by truth."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from hilbed.angle_arrays import wrap
from hilbed.attribution.evidence import evidence_of
from hilbed.attribution.rerun import rerun
from hilbed.record.readings import Signals
from hilbed.scenario.load import Loaded
from hilbed.types import Array


class Error(NamedTuple):
    """Root of the mean square over the run: of the position (m) and of the yaw (rad); NaN: no estimate."""

    position: float
    yaw: float


class Share(NamedTuple):
    """A source of error: what is left when it alone is replaced by truth, and when all others are."""

    source: str
    without: Error
    alone: Error


class Attribution(NamedTuple):
    """The error of the run, of its rerun with nothing replaced, of one with everything replaced; shares."""

    recorded: Error
    rerun: Error
    nothing: Error
    shares: Sequence[Share]


def attribute(loaded: Loaded, signals: Signals) -> Attribution | None:
    """Returns what each source adds to the error of a run's estimate; None where no truth is known.

    Shares do not add up: the sources act on one another, and on which readings pass the gate.
    """
    if not np.isfinite(signals["truth"]).all(axis=1).any() or "odometry_step" not in signals:
        return None
    evidence = evidence_of(loaded, signals)
    sources = evidence.sources
    errors = {
        replaced: _error(signals["truth"], rerun(loaded, evidence, replaced))
        for replaced in _combinations(sources)
    }
    everything = frozenset(sources)
    shares = [
        Share(source, errors[frozenset((source,))], errors[everything - {source}]) for source in sources
    ]
    recorded = _error(signals["truth"], signals["estimate"])
    return Attribution(recorded, errors[frozenset()], errors[everything], shares)


def as_dict(found: Attribution) -> dict[str, object]:
    """Returns it as attribution.json has it; NaN is null."""
    return {
        "recorded": _plain(found.recorded),
        "rerun": _plain(found.rerun),
        "all_replaced": _plain(found.nothing),
        "sources": {
            share.source: {"without": _plain(share.without), "alone": _plain(share.alone)}
            for share in found.shares
        },
    }


def _combinations(sources: Sequence[str]) -> list[frozenset[str]]:
    """Returns what is replaced in each rerun: nothing, one, all but one, all."""
    everything = frozenset(sources)
    single = [frozenset((source,)) for source in sources]
    return list(dict.fromkeys([frozenset(), *single, *[everything - one for one in single], everything]))


def _error(truth: Array, estimate: Array | None) -> Error:
    if estimate is None:
        return Error(np.nan, np.nan)
    off = estimate - truth
    yaw = wrap(off[:, 2])
    squares = off[:, 0] ** 2 + off[:, 1] ** 2, yaw**2
    return Error(*(float(np.sqrt(np.nanmean(square))) for square in squares))


def _plain(error: Error) -> Mapping[str, float | None]:
    return {name: value if np.isfinite(value) else None for name, value in error._asdict().items()}
