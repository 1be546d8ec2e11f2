"""`hilbed sweep`: one scenario over many seeds and values, in parallel, as one table."""

from __future__ import annotations

import json
import multiprocessing
import os
from argparse import Namespace
from collections.abc import Iterator, Sequence
from concurrent.futures import BrokenExecutor, Executor, ProcessPoolExecutor, as_completed
from itertools import product
from typing import Any, NamedTuple

from hilbed.console import end_progress, progress, quiet_pipe
from hilbed.scenario.load import load
from hilbed.scenario.model import Scenario
from hilbed.types import HilbedError, ScenarioError
from hilbed.workers import prepare

Settings = tuple[str, ...]

MOST_SEEDS = 100_000


class Job(NamedTuple):
    """One run of a sweep; detector: as for `hilbed run`."""

    scenario: str
    settings: Settings
    seed: int
    detector: str | None = None


class Result(NamedTuple):
    """How a job ended: exit status and the content of its verdict.json."""

    job: Job
    status: int
    verdict: dict[str, Any]


class Line(NamedTuple):
    """One number over the seeds; `worst` is the seed on the wrong side of a criterion, or its largest."""

    name: str
    mean: float
    low: float
    high: float
    worst: int
    passed: int | None


def sweep(options: Namespace) -> int:
    """Runs a scenario over seeds `A..B` and `PATH=V1,V2` settings, prints the table, returns the status.

    0 where every criterion of every run is met, else 1. Raises ScenarioError before the first run.
    """
    scenario, detector = options.scenario, options.detector
    if options.jobs is not None and options.jobs < 1:
        raise ScenarioError(f"--jobs {options.jobs}: at least one process has to run")
    variants = list(_variants(options.settings))
    for variant in variants:
        check_alone(load(scenario, variant, detector=detector).scenario)
    numbers = parse_seeds(options.seeds)
    todo = [Job(scenario, variant, seed, detector) for variant in variants for seed in numbers]
    results = side_by_side(todo, options.jobs)
    tables = {variant: tabulate([r for r in results if r.job.settings == variant]) for variant in variants}
    with quiet_pipe():
        print(as_text(tables, results) if not options.json else as_json_text(tables, results))
    return 0 if all(result.status == 0 for result in results) else 1


def side_by_side(todo: Sequence[Job], jobs: int | None) -> list[Result]:
    """Runs jobs in `jobs` processes, else one a processor, and returns the results in their order."""
    workers = max(1, min(jobs or os.cpu_count() or 1, len(todo)))
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(workers, mp_context=context, initializer=prepare) as pool:
        return run_all(todo, pool)


def check_alone(scenario: Scenario) -> None:
    """Raises ScenarioError where runs side by side would be in each other's way."""
    if scenario.bus.carried:
        raise ScenarioError(
            f"bus.interface: {scenario.bus.interface}; the runs of a sweep cannot share a bus: "
            "--set bus.interface=null sweeps the simulated one"
        )


def parse_seeds(text: str) -> range:
    """Returns the seeds of `A..B`, or of a single number; raises ScenarioError."""
    first, dots, last = text.partition("..")
    if not first.isdecimal() or (dots and not last.isdecimal()):
        raise ScenarioError(f"--seeds {text}: give A..B with whole numbers, such as 1..40")
    seeds = range(int(first), int(last if dots else first) + 1)
    if seeds.stop > MOST_SEEDS + seeds.start:
        raise ScenarioError(f"--seeds {text}: more than {MOST_SEEDS} seeds")
    if not seeds:
        raise ScenarioError(f"--seeds {text}: there is no seed from {first} to {last}")
    return seeds


def _variants(settings: Sequence[str]) -> Iterator[Settings]:
    """Yields one tuple of settings for each combination of the values listed in them."""
    choices = []
    for setting in settings:
        path, equals, values = setting.partition("=")
        choices.append([f"{path}{equals}{value}" for value in split_values(values)])
    yield from product(*choices)


def listed(option: str, text: str) -> tuple[str, list[str]]:
    """Returns path and values of an option's `PATH=V1,V2`; raises ScenarioError."""
    path, equals, values = text.partition("=")
    found = split_values(values)
    if not path or not equals or not all(found):
        raise ScenarioError(f"{option} {text}: give PATH=V1,V2,…, such as sensors.camera.read_noise=0,0.02")
    return path, found


def split_values(text: str) -> list[str]:
    """Splits `V1,V2` at the commas outside brackets and braces."""
    values, depth = [""], 0
    for letter in text:
        depth += (letter in "[{") - (letter in "]}")
        if letter == "," and depth == 0:
            values.append("")
        else:
            values[-1] += letter
    return values


def run_all(jobs: Sequence[Job], pool: Executor) -> list[Result]:
    """Runs the jobs on any executor, with a line of progress, and returns the results in their order."""
    futures = [pool.submit(run_job, job) for job in jobs]
    try:
        for done, _ in enumerate(as_completed(futures), 1):
            progress(f"sweep: {done} of {len(futures)} runs")
        return [future.result() for future in futures]
    except KeyboardInterrupt:
        for process in multiprocessing.active_children():
            process.terminate()  # what they were at is of no use any more
        pool.shutdown(wait=False, cancel_futures=True)
        raise
    except BrokenExecutor:
        raise HilbedError(
            "a process of the sweep has ended before its run: killed, or out of memory?"
        ) from None
    finally:
        end_progress()


def run_job(job: Job) -> Result:
    """Runs one job without writing anything."""
    from hilbed.runner import perform

    outcome = perform(load(job.scenario, [*job.settings, "record=none"], job.seed, job.detector), None)
    return Result(job, outcome.status, dict(outcome.verdict))


def tabulate(results: Sequence[Result]) -> list[Line]:
    """Returns the lines of the criteria, then those of the metrics, over the results of one variant."""
    criteria = {name: body for result in results for name, body in result.verdict["criteria"].items()}
    metrics = {name for result in results for name in result.verdict["metrics"]}
    lines = [_criterion(name, body, results) for name, body in criteria.items()]
    return lines + [line for name in sorted(metrics) if (line := _metric(name, results))]


def _criterion(name: str, body: dict[str, Any], results: Sequence[Result]) -> Line:
    rows = [(r.verdict["criteria"].get(name, {}), r.job.seed) for r in results]
    values = [(row.get("value"), seed) for row, seed in rows]
    known = [(value, seed) for value, seed in values if value is not None]
    missing = [seed for value, seed in values if value is None]
    line = _line(name, known, least=body.get("bound") == "min")
    passed = sum(bool(row.get("passed")) for row, _ in rows)
    return line._replace(passed=passed, worst=missing[0] if missing else line.worst)


def _metric(name: str, results: Sequence[Result]) -> Line | None:
    values = [(r.verdict["metrics"].get(name), r.job.seed) for r in results]
    known = [(value, seed) for value, seed in values if value is not None]
    return _line(name, known, least=False) if known else None


def _line(name: str, values: Sequence[tuple[float, int]], least: bool) -> Line:
    if not values:
        nan = float("nan")
        return Line(name, nan, nan, nan, -1, None)
    numbers = [value for value, _ in values]
    worst = (min if least else max)(values)[1]
    return Line(name, sum(numbers) / len(numbers), min(numbers), max(numbers), worst, None)


def as_text(tables: dict[Settings, list[Line]], results: Sequence[Result]) -> str:
    """Returns the tables for a terminal, one a variant, criteria first."""
    parts = []
    for variant, lines in tables.items():
        runs = [r for r in results if r.job.settings == variant]
        passed = sum(r.status == 0 for r in runs)
        parts.append(
            f"{runs[0].job.scenario} {' '.join(variant)}".rstrip() + f": {passed} of {len(runs)} passed"
        )
        parts.append(f"  {'':34}{'mean':>12}{'least':>12}{'largest':>12}{'worst seed':>12}  met")
        parts += [_row(line, len(runs)) for line in lines]
        parts += [f"  seed {r.job.seed}: {r.verdict['reason']}" for r in runs if r.status > 1]
    return "\n".join(parts)


def _row(line: Line, runs: int) -> str:
    met = "" if line.passed is None else f"{line.passed}/{runs}"
    numbers = "".join(f"{number:12.5g}" for number in (line.mean, line.low, line.high))
    return f"  {line.name:34}{numbers}{line.worst:12d}  {met}".rstrip()


def as_json_text(tables: dict[Settings, list[Line]], results: Sequence[Result]) -> str:
    """Returns the tables and every single run as JSON."""
    runs = [{"seed": r.job.seed, "set": r.job.settings, "status": r.status, **r.verdict} for r in results]
    table = [
        {"set": variant, "lines": [_as_dict(line) for line in lines]} for variant, lines in tables.items()
    ]
    return json.dumps({"tables": table, "runs": runs}, indent=2)


def _as_dict(line: Line) -> dict[str, Any]:
    """Returns a line for JSON, which has no word for what is not a number."""
    return {key: None if value != value else value for key, value in line._asdict().items()}
