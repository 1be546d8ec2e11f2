"""Several runs in one drawing: paths, poses, inputs, errors."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from hilbed.criteria.pose import turned, wrapped
from hilbed.paper.drawings import Runs, longest
from hilbed.report import state_figures, style
from hilbed.report.run import Run
from hilbed.report.state_figures import unjoined

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLOURS = ("estimate", "odometry", "left", "right", "bad", "muted", "good", "truth")
AROUND = 0.15  # m: what is shown of the neighbourhood of the goal


def colour_of(k: int) -> dict[str, Any]:
    """Returns how the k-th run is drawn: eight colours, then the same dashed."""
    dashes = "-" if k < len(COLOURS) else (0, (4, 2))
    return {"color": style.STAND_IN[COLOURS[k % len(COLOURS)]], "linestyle": dashes}


def paths(runs: Runs) -> str | None:
    """Returns the true paths over their references, with squares at the start and crosses at the end."""
    figure, (axes,) = style.sheet(1, 4.2)
    for reference in _references(runs):
        axes.plot(*reference.T[:2], color=style.STAND_IN["reference"], linewidth=5.0, alpha=0.5)
    for k, (name, run) in enumerate(runs.items()):
        _path(axes, run, k, name)
    _on_map(axes)
    axes.set_aspect("equal", adjustable="datalim")
    return style.svg(figure, "paths")


def goal(runs: Runs) -> str | None:
    """Returns the last part of the paths, near the goal."""
    figure, (axes,) = style.sheet(1, 4.2)
    for k, (name, run) in enumerate(runs.items()):
        _path(axes, run, k, name)
    x, y = next(iter(runs.values())).signals["reference"][-1, :2]
    axes.plot(x, y, "o", markersize=9, fillstyle="none", color=style.STAND_IN["muted"], label="goal")
    axes.set_xlim(x - AROUND, x + AROUND)
    axes.set_ylim(y - AROUND, y + AROUND)
    _on_map(axes)
    axes.set_aspect("equal", adjustable="box")
    return style.svg(figure, "paths near the goal")


def _references(runs: Runs) -> list[np.ndarray]:
    """Returns each reference that is known and moves, once."""
    found: list[np.ndarray] = []
    for run in runs.values():
        reference = run.signals["reference"]
        moves = np.isfinite(reference).all() and np.ptp(reference[:, :2], axis=0).any()
        if moves and not any(np.array_equal(reference, other) for other in found):
            found.append(reference)
    return found


def _path(axes: Axes, run: Run, k: int, name: str) -> None:
    x, y = run.signals["truth"][:: max(1, len(run.signals["t"]) // 2000), :2].T
    axes.plot(x, y, label=name, **colour_of(k))
    for at, marker in ((0, "s"), (-1, "x")):
        place = run.signals["truth"][at, :2]
        axes.plot(*place, marker, markersize=5, color=colour_of(k)["color"])


def _on_map(axes: Axes) -> None:
    axes.set_xlabel("x  [m]")
    axes.set_ylabel("y  [m]")
    style.legend(axes, 2.0)


def poses(runs: Runs) -> str | None:
    """Returns true x, y and yaw over time."""
    return _over_time(runs, ("x  [m]", "y  [m]", "yaw  [rad]"), lambda run: run.signals["truth"], "poses")


def inputs(runs: Runs) -> str | None:
    """Returns both components of the commands over time."""
    labels = state_figures.command_labels(next(iter(runs.values())))
    return _over_time(runs, labels, lambda run: run.signals["command"], "inputs")


def tracked(runs: Runs) -> str | None:
    """Returns reference minus truth in x, y and yaw over time."""
    return _over_time(runs, ("x  [m]", "y  [m]", "yaw  [rad]"), _from_reference, "tracking errors")


def _from_reference(run: Run) -> np.ndarray:
    error = run.signals["reference"] - run.signals["truth"]
    error[:, 2] = turned(run.signals, "reference")
    return error


def located(run: Run) -> str | None:
    """Returns the errors in x, y and yaw of dead reckoning and of the estimate."""
    errors = {}
    for name in ("odometry", "estimate"):
        errors[name] = run.signals[name] - run.signals["truth"]
        errors[name][:, 2] = wrapped(errors[name][:, 2])
    figure, axes = style.sheet(3, 4.4)
    for column, (axis, label) in enumerate(zip(axes, ("x  [m]", "y  [m]", "yaw  [rad]"), strict=True)):
        for name, error in errors.items():
            t, thin = style.thinned(run.signals["t"], error[:, column])
            axis.plot(t, thin, color=style.STAND_IN[name], label=name)
        axis.set_ylabel(label)
    style.legend(axes[0])
    style.on_time(axes, run.signals["t"], run.spans)
    return style.svg(figure, "errors of dead reckoning and estimate")


def _over_time(runs: Runs, labels: tuple[str, ...], columns: Any, title: str) -> str:
    """Returns the columns (N, n) that a function takes of each run, one above the other."""
    figure, axes = style.sheet(len(labels), 0.8 + 1.2 * len(labels))
    for k, (name, run) in enumerate(runs.items()):
        for axis, label, column in zip(axes, labels, columns(run).T, strict=True):
            t, thin = style.thinned(run.signals["t"], column)
            axis.plot(t, unjoined(thin) if label.startswith("yaw") else thin, label=name, **colour_of(k))
            axis.set_ylabel(label)
    style.legend(axes[0])
    style.on_time(axes, longest(runs), ())
    return style.svg(figure, title)
