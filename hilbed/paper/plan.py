"""What has to be run for a paper, and how each run is called."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from hilbed.paper.catalogue import TWIN, Figure, Paper
from hilbed.scenario import bundled


class Experiment(NamedTuple):
    """A run that is kept in a folder.

    name: that of its scenario or, where a value varies, `SCENARIO@VALUE`.
    """

    name: str
    scenario: str
    folder: Path
    settings: tuple[str, ...] = ()


class End(NamedTuple):
    """A run of which only the true pose at the end is asked."""

    scenario: str
    seed: int


def experiments(paper: Paper, folder: Path, ideal: bool) -> list[Experiment]:
    """Returns the runs of a paper in its order, each followed by its twin; ideal: without the twins."""
    known = set(bundled.names())
    names = [one for name in paper.scenarios() for one in (name, name + TWIN)]
    kept = [name for name in names if name in known and not (ideal and name.endswith(TWIN))]
    runs = [Experiment(name, name, folder / place(name)) for name in kept]
    figures = [figure for section in paper.sections for figure in section.figures]
    varied = {run.name: run for figure in figures for run in _varied(figure, folder)}
    return runs + list(varied.values())


def _varied(figure: Figure, folder: Path) -> Iterator[Experiment]:
    if figure.vary is not None:
        for name, value in variants(figure):
            scenario = name.partition("@")[0]
            yield Experiment(name, scenario, folder / place(name), (f"{figure.vary.path}={value!r}",))


def variants(figure: Figure) -> list[tuple[str, float]]:
    """Returns the names of a figure's runs in which a value varies, each with that value."""
    values = [] if figure.vary is None else figure.vary.values
    return [(f"{scenario}@{value:g}", value) for scenario in figure.scenarios for value in values]


def place(name: str) -> str:
    """Returns the folder of a run below that of its paper."""
    return name.rpartition("/")[2].replace("@", "-at-")


def ends(paper: Paper, most: int | None) -> list[End]:
    """Returns the runs behind the tables of final poses; most: so many seeds a scenario at most."""
    tables = [section.table for section in paper.sections if section.table is not None]
    found = []
    for table in tables:
        first, last = table.seeds
        seeds = range(first, last + 1)[:most]
        found += [End(scenario, seed) for scenario in table.scenarios for seed in seeds]
    return found
