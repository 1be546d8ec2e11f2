"""Runs the experiments of a paper, each into a folder of its own, side by side in processes."""

from __future__ import annotations

import multiprocessing
import signal
from collections import deque
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor, ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any, NamedTuple

from hilbed.console import end_progress, progress
from hilbed.types import HilbedError, Pose


class Experiment(NamedTuple):
    """A scenario to be run and kept in a folder."""

    scenario: str
    folder: Path


class End(NamedTuple):
    """A scenario of which only the true pose at the end is asked."""

    scenario: str
    seed: int


def perform_all(
    experiments: Sequence[Experiment], ends: Sequence[End], jobs: int
) -> tuple[dict[str, int], dict[End, Pose]]:
    """Runs everything; returns the exit status of each scenario and the final pose of each end."""
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(max(jobs, 1), mp_context=context, initializer=_deaf) as pool:
        try:
            return _gather(experiments, ends, pool)
        except KeyboardInterrupt:
            for process in multiprocessing.active_children():
                process.terminate()
            pool.shutdown(wait=False, cancel_futures=True)
            raise
        finally:
            end_progress()


def _deaf() -> None:
    """Leaves Ctrl-C to the process that leads."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _gather(
    experiments: Sequence[Experiment], ends: Sequence[End], pool: Executor
) -> tuple[dict[str, int], dict[End, Pose]]:
    runs = {one.scenario: pool.submit(run, one) for one in experiments}
    finals = {one: pool.submit(final_pose, one) for one in ends}
    futures: list[Any] = [*runs.values(), *finals.values()]
    for done, _ in enumerate(as_completed(futures), 1):
        progress(f"paper: {done} of {len(futures)} runs")
    return _results(runs), _results(finals)


def _results(futures: Mapping[Any, Any]) -> dict[Any, Any]:
    return {key: future.result() for key, future in futures.items()}


def run(experiment: Experiment) -> int:
    """Runs a scenario into its folder, report and all, and returns its exit status."""
    from hilbed.record.folder import RunFolder
    from hilbed.report import write_report
    from hilbed.runner import perform
    from hilbed.scenario.load import load

    loaded = load(experiment.scenario, ["record=signals"])
    outcome = perform(loaded, RunFolder(experiment.folder, force=True))
    if outcome.trace:
        raise HilbedError(f"{experiment.scenario}: {outcome.verdict['reason']}\n{outcome.trace}")
    write_report(experiment.folder)
    return outcome.status


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
