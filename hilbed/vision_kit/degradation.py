"""What one value of a camera does to the robot: whole runs over it, as one table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import nan
from typing import Any, NamedTuple

from hilbed.scenario.load import Loaded, load
from hilbed.sweep import Job, Result, check_alone, side_by_side
from hilbed.types import ScenarioError


class Effect(NamedTuple):
    """A number of a run that is shown over the values: its metric, unit, and factor."""

    title: str
    metric: str
    unit: str
    scale: float = 1.0


EFFECTS = (
    Effect("azimuth error (rms)", "azimuth_rms_mdeg", "mdeg"),
    Effect("azimuths delivered", "azimuth_count", ""),
    Effect("accepted by the filter", "accepted_fraction", "%", 100.0),
    Effect("error of the estimate (rms)", "estimate_position_rms", "cm", 100.0),
    Effect("off the path (rms)", "cross_track_rms", "cm", 100.0),
)


class Variant(NamedTuple):
    """The runs with one value, over seeds."""

    value: str
    results: Sequence[Result]

    def numbers(self, effect: Effect) -> list[float]:
        """Returns an effect of each run; NaN where the run has no such number."""
        return [_number(result.verdict["metrics"], effect) for result in self.results]

    @property
    def passed(self) -> int:
        return sum(result.status == 0 for result in self.results)


def _number(metrics: Mapping[str, float | None], effect: Effect) -> float:
    value = metrics.get(effect.metric)
    return nan if value is None else effect.scale * value


class Sweep(NamedTuple):
    """A scenario over the values of one path."""

    scenario: str
    path: str
    variants: Sequence[Variant]

    def setting(self, variant: Variant) -> str:
        return f"{self.path}={variant.value}"


class Task(NamedTuple):
    """What is to be run: a scenario with settings and perhaps a detector, over the values of a path."""

    scenario: str
    settings: Sequence[str]
    detector: str | None
    path: str
    values: Sequence[str]

    def load(self, value: str, seed: int | None = None) -> Loaded:
        """Reads the scenario with one of the values; raises ScenarioError."""
        return load(self.scenario, self.with_value(value), seed, self.detector)

    def with_value(self, value: str) -> tuple[str, ...]:
        return (*self.settings, f"{self.path}={value}")


def run_sweep(task: Task, seeds: Sequence[int], jobs: int | None) -> Sweep:
    """Runs a scenario with each value and seed; raises ScenarioError before the first run."""
    if jobs is not None and jobs < 1:
        raise ScenarioError(f"--jobs {jobs}: at least one process has to run")
    loaded = [task.load(value) for value in task.values]
    for one in loaded:
        check_alone(one.scenario)
    todo = [
        Job(task.scenario, task.with_value(value), seed, task.detector)
        for value in task.values
        for seed in seeds
    ]
    results = side_by_side(todo, jobs)
    size = len(seeds)
    variants = [Variant(value, results[k * size : (k + 1) * size]) for k, value in enumerate(task.values)]
    return Sweep(loaded[0].name, task.path, variants)


def content(sweep: Sweep) -> dict[str, Any]:
    """Returns what sweep.json holds: every effect of every run."""
    rows = [
        {
            "value": variant.value,
            "seed": result.job.seed,
            "status": result.status,
            "reason": result.verdict["reason"],
            **{effect.metric: result.verdict["metrics"].get(effect.metric) for effect in EFFECTS},
        }
        for variant in sweep.variants
        for result in variant.results
    ]
    return {"scenario": sweep.scenario, "path": sweep.path, "runs": rows}


def table(sweep: Sweep) -> str:
    """Returns the means over the seeds, a line for each value."""
    heads = [sweep.path.rpartition(".")[2], *(f"{e.metric}" for e in EFFECTS), "met"]
    rows = [heads]
    for variant in sweep.variants:
        means = [f"{_mean(variant.numbers(e)) / e.scale:.4g}" for e in EFFECTS]
        rows.append([variant.value, *means, f"{variant.passed}/{len(variant.results)}"])
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return "\n".join(
        "  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True)) for row in rows
    )


def _mean(values: Sequence[float]) -> float:
    known = [value for value in values if value == value]
    return sum(known) / len(known) if known else nan
