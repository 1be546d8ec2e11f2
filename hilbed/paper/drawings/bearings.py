"""Observers of landmarks over one another: Ishikawa & Sampei (1994), Fig. 3 and 4; errors of the sights."""

from __future__ import annotations

import numpy as np

from hilbed.angle_arrays import wrap
from hilbed.paper.drawings import Runs, first, longest
from hilbed.paper.drawings.overlays import colour_of
from hilbed.report import style
from hilbed.report.run import Run
from hilbed.report.state_figures import landmark_distance

LEAST = 1e-9  # m, rad: smaller errors are drawn there


def positions(runs: Runs) -> str | None:
    """Returns estimated x and y beside the true ones: Fig. 3."""
    return _estimates(runs, (0, 1), ("x  [m]", "y  [m]"), "estimated positions")


def headings(runs: Runs) -> str | None:
    """Returns estimated heading and distance of the landmarks beside the true ones: Fig. 4."""
    return _estimates(runs, (2, 3), ("yaw  [rad]", "l  [m]"), "estimated heading and landmark distance")


def _estimates(runs: Runs, columns: tuple[int, int], labels: tuple[str, str], title: str) -> str:
    figure, axes = style.sheet(2, 3.6)
    for axis, column, label in zip(axes, columns, labels, strict=True):
        for k, (name, run) in enumerate(runs.items()):
            t, thin = style.thinned(run.signals["t"], estimated(run)[:, column])
            axis.plot(t, thin, label=name, **colour_of(k))
        true = surveyed(first(runs))[:, column]
        axis.plot(first(runs).signals["t"], true, color=style.STAND_IN["truth"], linestyle=":", label="truth")
        low, high = true.min(), true.max()
        axis.set_ylim(low - 2.0, high + 2.0)  # the first guesses may be far away
        axis.set_ylabel(label)
    style.legend(axes[0])
    style.on_time(axes, longest(runs), ())
    return style.svg(figure, title)


def sights(runs: Runs) -> str | None:
    """Returns the errors of distance and angle of both landmarks, in magnitude."""
    labels = ("r_A  [m]", "φ_A  [rad]", "r_B  [m]", "φ_B  [rad]")
    figure, axes = style.sheet(4, 5.6)
    for k, (name, run) in enumerate(runs.items()):
        error = polar(estimated(run)) - polar(surveyed(run))
        error[:, 1::2] = wrap(error[:, 1::2])
        for axis, column, label in zip(axes, error.T, labels, strict=True):
            t, thin = style.thinned(run.signals["t"], np.maximum(np.abs(column), LEAST))
            axis.plot(t, thin, label=name, **colour_of(k))
            axis.set_yscale("log")
            axis.set_ylabel(label)
    style.legend(axes[0])
    style.on_time(axes, longest(runs), ())
    return style.svg(figure, "errors of the sights")


def estimated(run: Run) -> np.ndarray:
    """Returns the estimated x, y, yaw, l (N, 4)."""
    return np.column_stack((run.signals["estimate"], run.signals["landmark_distance"]))


def surveyed(run: Run) -> np.ndarray:
    """Returns the true x, y, yaw, l (N, 4)."""
    return np.column_stack((run.signals["truth"], np.full(len(run.signals["t"]), landmark_distance(run))))


def polar(states: np.ndarray) -> np.ndarray:
    """Returns r_A, φ_A, r_B, φ_B (N, 4) of x, y, yaw, l (N, 4): (5)."""
    x, y, yaw, l = states.T  # noqa: E741
    columns = []
    for away in (y, y - l):
        columns += [np.hypot(x, away), wrap(yaw - np.arctan2(away, x))]
    return np.column_stack(columns)
