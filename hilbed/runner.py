"""One run from a loaded scenario to a verdict.

However it ends, the drives are stopped, the logs are kept and verdict.json says why.
"""

from __future__ import annotations

import os
import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import isfinite
from typing import Any, NamedTuple
from urllib.parse import quote

import numpy as np

from hilbed import collector, loop, verdict, yaml12
from hilbed.build import Bench, build
from hilbed.build.elsewhere import check_armed
from hilbed.clock import SECOND, nanos, seconds
from hilbed.cost import Cost, perf_counter, since
from hilbed.pacer import Pacer
from hilbed.ports import Sensor
from hilbed.record.columns import Columns
from hilbed.record.folder import DBC, DETECTORS, RunFolder
from hilbed.record.hashing import BusDigest, run_hash, signals_hash
from hilbed.record.journal import HELPING, Journal
from hilbed.record.notes import Notes
from hilbed.record.row import Sink
from hilbed.scenario.load import Loaded, resolved
from hilbed.scenario.model import Scenario
from hilbed.scenario.own_files import pack
from hilbed.sensors.camera import Camera
from hilbed.sensors.troubles import Troubles
from hilbed.tally import counts_of
from hilbed.types import BusError, Cycle, Diverged, HilbedError, Interrupted, Nanos
from hilbed.versions import versions

PASSED, FAILED, INTERRUPTED, BROKEN, BUS = 0, 1, 2, 3, 7

PATH_STEP: Nanos = 200_000_000
"""How often the reference path is drawn into the log."""


class Outcome(NamedTuple):
    """How a run ended: exit status, the content of verdict.json, the traceback of an internal error."""

    status: int
    verdict: Mapping[str, Any]
    trace: str


@dataclass(frozen=True)
class Watch:
    """What the outside may do with a run: ask it to stop (a word why, or None), follow its cycles."""

    stop: Callable[[], str | None] = lambda: None
    cycle: Callable[[Cycle], None] = lambda _: None


def processors() -> int:
    """Returns how many processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class _Ending:
    """How a run ends; the first thing that goes wrong is the cause, what follows from it is not told."""

    def __init__(self) -> None:
        self.status = PASSED
        self.reason = ""
        self.trace = ""
        self.wall = 0.0
        self.cost = Cost().as_dict()
        self.beside = Cost().as_dict()
        self.last: Nanos = 0

    def set(self, status: int, reason: str, trace: str = "") -> None:
        if self.status == PASSED:
            self.status, self.reason, self.trace = status, reason, trace

    def attempt(self, step: Callable[[], object]) -> None:
        """Does a step of the run; an error ends the run with its own status instead of a traceback."""
        try:
            step()
        except BusError as error:
            self.set(BUS, str(error))
        except Interrupted as error:
            self.set(INTERRUPTED, str(error))
        except Diverged as error:
            self.set(BROKEN, str(error))
        except HilbedError as error:  # disk full, a camera's process lost
            self.set(BROKEN, f"t = {seconds(self.last):.3f} s: {error}")
        except KeyboardInterrupt:
            self.set(INTERRUPTED, f"SIGINT at t = {seconds(self.last):.3f} s")
        except Exception as error:
            place = f"after t = {seconds(self.last):.3f} s"
            self.set(BROKEN, f"internal error {place}: {error!r}", traceback.format_exc())


def perform(
    loaded: Loaded,
    folder: RunFolder | None,
    watch: Watch | None = None,
    separate: bool = False,
    armed: bool = False,
) -> Outcome:
    """Builds the bench of a scenario, runs it and judges it; with a folder the run is written there.

    separate: cameras render in processes of their own, and the logs are written in one; the run is the same,
    only quicker on two processors.
    armed: whether real motors may turn.

    Raises ScenarioError for what is found before the first cycle, when nothing has been written yet.
    """
    check_armed(loaded.scenario, armed)
    cost, notes, ending = Cost(), Notes(), _Ending()
    pacer = _pacer(loaded.scenario, cost)
    bench = build(loaded, notes, cost, separate, pacer)
    columns, bus = Columns(bench.drives, bench.kinds), BusDigest()
    try:
        sinks = [] if folder is None else _logs(bench, loaded, folder, separate)
        helping = 0 if pacer else HELPING
        journal = Journal(notes, [columns, bus, *sinks], cost, bench.start, bench.reference, helping)
        _run(bench, journal, nanos(loaded.scenario.duration), watch or Watch(), ending)
    finally:
        bench.close()
    rows = ending.last // bench.tick + 1  # the log goes on while the drives stop
    ticks = {name: column[:rows] for name, column in bench.ticks(0).items()}
    signals = columns.finish(ticks, bench.tick)
    if bench.beacons:
        signals["beacons"] = np.array([beacon.at for beacon in bench.beacons])
    if pacer is not None:
        signals |= {name: np.array(column) for name, column in pacer.ledger.columns().items()}
    if folder is not None and loaded.scenario.record != "none":
        ending.attempt(lambda: folder.write_signals(signals))
        ending.attempt(lambda: folder.keep(_heard(bench, loaded.scenario)))
    account = verdict.Account(
        scenario=loaded.name,
        seed=loaded.scenario.seed,
        reason=ending.reason,
        sim_time=seconds(ending.last),
        wall_time=ending.wall,
        cost=ending.cost,
        beside=ending.beside,
        hash=run_hash(signals, bus.digest()),
        signals_hash=signals_hash(signals),
        events=bench.events(),
        parts=_parts(bench, loaded.scenario, pacer),
    )
    content = verdict.conclude(account, signals, loaded.scenario.criteria)
    if folder is not None:
        ending.attempt(lambda: folder.write_verdict(verdict.text(content)))
    return Outcome(_status(content, ending), content, ending.trace)


def _pacer(scenario: Scenario, cost: Cost) -> Pacer | None:
    spec = scenario.realtime
    return None if spec is None else Pacer(spec, nanos(scenario.period), cost)


def _parts(bench: Bench, scenario: Scenario, pacer: Pacer | None) -> dict[str, Any]:
    """Returns what verdict.json says of counters, detectors, a run in real time, a bus that others are on."""
    counted = {"estimator": counts_of(bench.rig.estimator), "controller": counts_of(bench.rig.controller)}
    sensors = _sensors(bench, scenario)
    counted |= {
        f"sensors.{name}": counts for name, sensor in sensors.items() if (counts := counts_of(sensor))
    }
    foreign = _foreign(sensors)
    parts = {
        "counts": {name: _numbers(counts) for name, counts in counted.items()},
        "reproducible": pacer is None and all(troubles.reproducible for troubles in foreign.values()),
        **bench.account(),
    }
    if foreign:
        parts["detectors"] = {name: troubles.lines() for name, troubles in foreign.items()}
    if pacer is not None:
        parts["realtime"] = pacer.ledger.summary(pacer.period, bench.late())
    return parts


def _sensors(bench: Bench, scenario: Scenario) -> dict[str, Sensor]:
    """Returns the scenario's sensors by name; those that a recorded robot brings have none."""
    return dict(zip(scenario.sensors, bench.rig.sensors, strict=False))


def _foreign(sensors: Mapping[str, Sensor]) -> dict[str, Troubles]:
    """Returns what foreign detectors did wrong, by the camera's name."""
    return {
        name: sensor.troubles
        for name, sensor in sensors.items()
        if isinstance(sensor, Camera) and sensor.troubles.foreign
    }


def _heard(bench: Bench, scenario: Scenario) -> dict[str, bytes]:
    """Returns what foreign detectors have printed, by the file that it goes to."""
    return {
        f"{DETECTORS}/{quote(name, safe='')}.log": troubles.heard.encode()
        for name, troubles in _foreign(_sensors(bench, scenario)).items()
        if troubles.heard
    }


def _numbers(counts: Mapping[str, float]) -> dict[str, float | None]:
    return {name: value if isfinite(value) else None for name, value in counts.items()}


def _logs(bench: Bench, loaded: Loaded, folder: RunFolder, separate: bool) -> list[Sink]:
    """Starts the run folder and returns the logs that the scenario wants in it."""
    packed = pack(loaded.scenario, loaded.folder)  # before an old run goes, which they may be part of
    path = folder.start()
    text = yaml12.write(resolved(packed.scenario, versions()))
    folder.write("scenario.yaml", text)
    folder.keep(packed.contents)
    if loaded.scenario.record != "all":
        return []
    from hilbed.record.logs import Plan, open_logs
    from hilbed.record.mcap import Setting, events

    if bench.nodes:
        from hilbed.can.dbc import dbc

        folder.write(DBC, dbc(bench.nodes))
    happening = events(loaded.scenario.disturbances)
    setting = Setting(bench.beacons, _path(bench, loaded), 0.2, happening, text)
    plan = Plan(path, bench.power_on, setting, bool(bench.drives))
    if separate:
        from hilbed.record.remote import RemoteLogs

        return [RemoteLogs(plan, bench.rig.cost)]
    return open_logs(plan)


def _path(bench: Bench, loaded: Loaded) -> list[tuple[float, float]]:
    if bench.reference is None:
        return []
    times = range(0, nanos(loaded.scenario.duration), PATH_STEP)
    return [bench.reference.at(t).pose[:2] for t in times]


def _run(bench: Bench, journal: Journal, duration: Nanos, watch: Watch, ending: _Ending) -> None:
    """Boots, runs and stops; what goes wrong is kept in `ending`. Time and cost are those of the cycles."""
    cost = bench.rig.cost
    ending.attempt(lambda: bench.boot(lambda: _refuse_to_go_on(watch)))
    if ending.status == PASSED:
        start, before = perf_counter(), (cost.as_dict(), dict(cost.beside))
        with collector.paused():
            ending.attempt(lambda: _cycles(bench, journal, duration, watch, ending))
        ending.wall = perf_counter() - start
        ending.cost, ending.beside = since(before[0], cost.as_dict()), since(before[1], cost.beside)
    ending.attempt(lambda: bench.stop(ending.last))
    ending.attempt(journal.close)


def _refuse_to_go_on(watch: Watch) -> None:
    """Raises Interrupted once the run is asked to end: no motor is switched on after that."""
    asked = watch.stop()
    if asked is not None:
        raise Interrupted(f"{asked} while the drives were brought up")


def _cycles(bench: Bench, journal: Journal, duration: Nanos, watch: Watch, ending: _Ending) -> None:
    logged = 0
    for cycle in loop.run(bench.rig, duration, bench.pace):
        if cycle.t % SECOND == 0 or cycle.t == duration:
            rows = bench.ticks(logged)
            logged += len(rows.get("tick/t", ()))
            journal.ticks(rows)
        journal.record(cycle)
        ending.last = cycle.t
        watch.cycle(cycle)
        asked = watch.stop()
        if asked is not None:
            ending.set(INTERRUPTED, f"{asked} at t = {seconds(cycle.t):.3f} s")
            return


def _status(content: Mapping[str, Any], ending: _Ending) -> int:
    if ending.status != PASSED:
        return ending.status
    return PASSED if content["passed"] else FAILED
