"""One run from a loaded scenario to a verdict.

However it ends, the drives are stopped, the logs are kept and verdict.json says why.
"""

from __future__ import annotations

import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from hilbed import loop, verdict
from hilbed.build import Bench, build
from hilbed.clock import SECOND, nanos, seconds
from hilbed.cost import Cost, perf_counter
from hilbed.record.columns import Columns
from hilbed.record.disk import RecordError
from hilbed.record.folder import RunFolder
from hilbed.record.hashing import BusDigest, run_hash, signals_hash
from hilbed.record.journal import Journal
from hilbed.scenario.load import Loaded
from hilbed.types import BusError, Cycle, Diverged, Nanos

PASSED, FAILED, INTERRUPTED, BROKEN, BUS = 0, 1, 2, 3, 7

Signals = dict[str, np.ndarray[Any, Any]]


class Outcome(NamedTuple):
    """How a run ended: exit status, the content of verdict.json, its signals."""

    status: int
    verdict: Mapping[str, Any]
    signals: Signals


@dataclass
class Watch:
    """What the outside may do with a run: ask it to stop, follow its cycles."""

    stop: Callable[[], str | None] = lambda: None
    cycle: Callable[[Cycle], None] = lambda _: None


@dataclass
class _Ending:
    """Why a run ended before its time; nothing is wrong while `status` is PASSED."""

    status: int = PASSED
    reason: str = ""
    trace: str = ""
    wall: float = 0.0
    last: Nanos = field(default=0)

    def set(self, status: int, reason: str, trace: str = "") -> None:
        if self.status == PASSED:  # the first reason is the cause
            self.status, self.reason, self.trace = status, reason, trace


def perform(loaded: Loaded, folder: RunFolder | None, watch: Watch | None = None) -> Outcome:
    """Builds the bench of a scenario, runs it and judges it; with a folder the run is written there.

    Raises ScenarioError for what is found before the first cycle, when nothing has been written yet.
    """
    scenario, cost, ending = loaded.scenario, Cost(), _Ending()
    signals_sink, bus_sink = Columns(drives_of(scenario), kinds_of(scenario)), BusDigest()
    journal = Journal([signals_sink, bus_sink], cost, *origin(loaded))
    bench = build(loaded, journal, cost)
    try:
        if folder is not None:
            _open_logs(journal, folder, loaded)
        _run(bench, journal, nanos(scenario.duration), watch or Watch(), ending)
    finally:
        bench.close()
    _attempt(ending, journal.close)
    signals = signals_sink.finish(bench.ticks(0), bench.tick)
    return _judge(loaded, signals, bus_sink.digest(), cost, ending, folder)


def _run(bench: Bench, journal: Journal, duration: Nanos, watch: Watch, ending: _Ending) -> None:
    """Boots, runs and stops; what goes wrong is kept in `ending`."""
    _attempt(ending, bench.boot)
    if ending.status == PASSED:
        start = perf_counter()
        _attempt(ending, lambda: _cycles(bench, journal, duration, watch, ending))
        ending.wall = perf_counter() - start
    _attempt(ending, lambda: bench.stop(ending.last))


def _cycles(bench: Bench, journal: Journal, duration: Nanos, watch: Watch, ending: _Ending) -> None:
    logged = 0
    for cycle in loop.run(bench.rig, duration):
        journal.record(cycle)
        ending.last = cycle.t
        watch.cycle(cycle)
        if cycle.t % SECOND == 0:
            rows = bench.ticks(logged)
            logged += len(rows.get("tick/t", ()))
            journal.ticks(rows)
        signal = watch.stop()
        if signal is not None:
            ending.set(INTERRUPTED, f"{signal} at t = {seconds(cycle.t):.3f} s")
            return


def _attempt(ending: _Ending, step: Callable[[], None]) -> None:
    """Runs a step of the run; an error ends the run with its own status instead of a traceback."""
    when = f"t = {seconds(ending.last):.3f} s"
    try:
        step()
    except (Diverged, RecordError) as error:
        ending.set(BROKEN, str(error))
    except BusError as error:
        ending.set(BUS, str(error))
    except KeyboardInterrupt:
        ending.set(INTERRUPTED, f"SIGINT after {when}")
    except Exception as error:
        ending.set(BROKEN, f"internal error after {when}: {error!r}", traceback.format_exc())
