"""What can be drawn of runs, by its word in a paper's file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

from hilbed.criteria.signals import Column
from hilbed.paper.catalogue import Figure
from hilbed.report.run import Run

Runs = Mapping[str, Run]
"""Finished runs by the short name that a legend gives them."""

Drawer = Callable[[Runs, Figure], str | None]


def drawers() -> dict[str, Drawer]:
    """Returns every drawing by its word."""
    from hilbed.paper.drawings import bearings, clouds, headings, overlays
    from hilbed.report import drive_figures, pose_figures, sensor_figures, state_figures

    single: dict[str, Callable[[Run], str | None]] = {
        "path": pose_figures.path,
        "states": state_figures.states,
        "errors": pose_figures.errors,
        "tracking": pose_figures.tracking,
        "landmark": state_figures.landmark,
        "observability": state_figures.observability,
        "steering": drive_figures.steering,
        "speeds": drive_figures.speeds,
        "efforts": drive_figures.efforts,
        "nis": sensor_figures.nis,
        "located": overlays.located,
    }
    several: dict[str, Callable[[Runs], str | None]] = {
        "paths": overlays.paths,
        "goal": overlays.goal,
        "poses": overlays.poses,
        "inputs": overlays.inputs,
        "tracked": overlays.tracked,
        "positions": bearings.positions,
        "headings": bearings.headings,
        "sights": bearings.sights,
    }
    special: dict[str, Drawer] = {
        "fan": headings.fan,
        "prediction": clouds.prediction,
        "belief": clouds.belief,
        "controls": clouds.controls,
    }
    ones = {word: partial(_each, draw) for word, draw in single.items()}
    return ones | {word: partial(_all, draw) for word, draw in several.items()} | special


def _each(draw: Callable[[Run], str | None], runs: Runs, _: Figure) -> str | None:
    return "".join(draw(run) or "" for run in runs.values()) or None


def _all(draw: Callable[[Runs], str | None], runs: Runs, _: Figure) -> str | None:
    return draw(runs)


def first(runs: Runs) -> Run:
    """Returns the run of a drawing that shows only one."""
    return next(iter(runs.values()))


def longest(runs: Runs) -> Column:
    """Returns the times (N,) in s of the run that goes on longest, over which several are drawn."""
    times: list[Column] = [run.signals["t"] for run in runs.values() if len(run.signals["t"])]
    return max(times, key=lambda t: float(t[-1]))
