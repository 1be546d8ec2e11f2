"""Runs the experiments of a paper, each into a folder of its own, side by side in processes."""

from __future__ import annotations

import multiprocessing
from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import BrokenExecutor, Future, ProcessPoolExecutor, as_completed
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from hilbed.console import end_progress, progress
from hilbed.paper.kept import finished
from hilbed.paper.plan import End, Experiment
from hilbed.types import HilbedError, Pose
from hilbed.workers import prepare

KILLED = "a process has ended before its run: killed, or out of memory?"


class Done(NamedTuple):
    """How a run ended: exit status, why it did not pass, the traceback of an internal error.

    kept: whether it was there already.
    """

    status: int
    reason: str = ""
    trace: str = ""
    kept: bool = False


@dataclass
class Results:
    """What has come out so far; interrupted: whether the end was asked for; lost: what could not be run."""

    runs: dict[str, Done] = field(default_factory=dict)
    ends: dict[End, Pose] = field(default_factory=dict)
    lost: list[str] = field(default_factory=list)
    interrupted: bool = False

    def take(self, what: Experiment | End, future: Future[Any]) -> None:
        """Takes the result of a run, or notes why there is none."""
        try:
            if isinstance(what, Experiment):
                self.runs[what.name] = future.result()
            else:
                self.ends[what] = future.result()
        except BrokenExecutor:
            if KILLED not in self.lost:
                self.lost.append(KILLED)
        except Exception as error:  # of one run: the others still count
            name = what.name if isinstance(what, Experiment) else f"{what.scenario}, seed {what.seed}"
            self.lost.append(f"{name}: {error if isinstance(error, HilbedError) else repr(error)}")


def perform_all(experiments: Sequence[Experiment], ends: Sequence[End], jobs: int, force: bool) -> Results:
    """Runs everything, with a line of progress; what is interrupted or breaks leaves the rest as it is.

    force: also what an earlier run has left in its folder.
    """
    results, context = Results(), multiprocessing.get_context("spawn")
    work: list[tuple[Experiment | End, Callable[[], Any]]] = [
        *((one, partial(run, one, force)) for one in experiments),
        *((one, partial(final_pose, one)) for one in ends),
    ]
    with ProcessPoolExecutor(min(jobs, len(work)) or 1, mp_context=context, initializer=prepare) as pool:
        try:
            futures = {pool.submit(task): what for what, task in work}
            for done, future in enumerate(as_completed(futures), 1):
                results.take(futures[future], future)
                progress(f"paper: {done} of {len(futures)} runs")
        except KeyboardInterrupt:
            results.interrupted = True
            for process in multiprocessing.active_children():
                process.terminate()
            pool.shutdown(wait=False, cancel_futures=True)
        finally:
            end_progress()
    return results


def run(experiment: Experiment, force: bool) -> Done:
    """Runs a scenario into its folder where it is not there already.

    A report is written as well, but for those of many in which a value varies.
    """
    from hilbed.record.folder import REPORT, RunFolder
    from hilbed.runner import perform
    from hilbed.scenario.load import load

    loaded = load(experiment.scenario, [*experiment.settings, "record=signals"])
    failure = None if force else finished(experiment.folder, loaded)
    if failure is not None and (experiment.settings or (experiment.folder / REPORT).exists()):
        return Done(1 if failure else 0, failure, kept=True)
    outcome = perform(loaded, RunFolder(experiment.folder, force=True))
    report = "" if experiment.settings else _reported(experiment.folder)
    reasons = (str(outcome.verdict["reason"]), report)
    return Done(outcome.status, "; ".join(filter(None, reasons)), outcome.trace)


def _reported(folder: Path) -> str:
    """Writes the report of a run; returns why it could not, else nothing."""
    from hilbed.report import write_report

    try:
        write_report(folder)
    except HilbedError as error:
        return str(error)
    return ""


def final_pose(end: End) -> Pose:
    """Runs a scenario without writing anything and returns where the robot is at the end."""
    from hilbed import loop
    from hilbed.build import build
    from hilbed.clock import nanos
    from hilbed.cost import Cost
    from hilbed.record.notes import Notes
    from hilbed.scenario.load import load

    loaded = load(end.scenario, (), end.seed)
    bench = build(loaded, Notes(), Cost())
    try:
        bench.boot(lambda: None)
        (last,) = deque(loop.run(bench.rig, nanos(loaded.scenario.duration)), maxlen=1)
        return last.truth.pose
    finally:
        bench.close()
