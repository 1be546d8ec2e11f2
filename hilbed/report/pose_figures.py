"""Figures of the way the robot took and of how well it was known."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, TypeGuard

import numpy as np

from hilbed.criteria.pose import wrapped
from hilbed.report import style
from hilbed.report.run import Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_STYLES: dict[str, dict[str, Any]] = {
    "reference": {"linewidth": 5.0, "alpha": 0.6, "solid_capstyle": "round"},
    "odometry": {"linewidth": 1.0, "linestyle": (0, (4, 2))},
    "truth": {"linewidth": 1.5},
    "estimate": {"linewidth": 1.0},
}
_NOWHERE = np.empty((0, 2))


def path(run: Run) -> str | None:
    """Returns the path: reference, odometry, truth and estimate among the beacons; None without a pose."""
    signals = run.signals
    shown = {name: signals[name] for name in _STYLES if _known(signals.get(name))}
    if not shown:
        return None
    figure, (axes,) = style.sheet(1, 4.4)
    for kind in ("position", "pose"):
        measured = signals.get(f"{kind}/measured", _NOWHERE)[:, :2]
        dots = measured[:: max(1, len(measured) // 1000)]
        axes.scatter(dots[:, 0], dots[:, 1], s=5, linewidths=0, color=style.STAND_IN["muted"], alpha=0.6)
    for name, pose in shown.items():
        step = max(1, len(pose) // 4000)
        colour = style.STAND_IN[name]
        axes.plot(pose[::step, 0], pose[::step, 1], color=colour, label=name, **_STYLES[name])
    _draw_scene(axes, run)
    start = next(iter(pose[0] for name, pose in shown.items() if name in ("truth", "estimate")), None)
    if start is not None:
        axes.plot(start[0], start[1], "s", markersize=5, color=style.STAND_IN["good"], label="start")
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("x  [m]")
    axes.set_ylabel("y  [m]")
    style.legend(axes, 2.0)
    return style.svg(figure, "path of the robot")


def _draw_scene(axes: Axes, run: Run) -> None:
    """Draws the beacons with their numbers and the areas of disturbances with their letters."""
    muted, shade = style.STAND_IN["muted"], style.STAND_IN["shade"]
    for k, beacon in enumerate(run.beacons):
        colour = style.beacon_colour(beacon.colour)
        axes.plot(beacon.x, beacon.y, "o", markersize=7, color=colour, markeredgecolor=muted)
        axes.annotate(str(k), (beacon.x, beacon.y), (6, 4), textcoords="offset points", color=muted)
    for span in run.spans:
        if span.area:
            x0, y0, x1, y1 = span.area
            axes.fill([x0, x1, x1, x0], [y0, y0, y1, y1], color=shade, alpha=0.3, linewidth=0)
            corner = (max(x0, x1), max(y0, y1))
            axes.annotate(span.letter, corner, (2, 1), textcoords="offset points", color=shade, weight="bold")


def errors(run: Run) -> str | None:
    """Returns the errors of the estimate within three standard deviations; None without truth."""
    signals = run.signals
    if not (_known(signals.get("truth")) and _known(signals.get("estimate"))):
        return None
    error = signals["estimate"] - signals["truth"]
    error[:, 2] = wrapped(error[:, 2])
    bound = 3 * np.sqrt(np.maximum(np.diagonal(signals["covariance"], axis1=1, axis2=2), 0.0))
    figure, axes = style.sheet(3, 4.4)
    names = (("x", "cm", 100.0), ("y", "cm", 100.0), ("yaw", "°", 180 / np.pi))
    for k, (name, unit, scale) in enumerate(names):
        t, value, limit = style.thinned(signals["t"], error[:, k] * scale, bound[:, k] * scale)
        colour = style.STAND_IN["estimate"]
        if np.isfinite(limit).any():  # else the estimator states none
            axes[k].fill_between(t, -limit, limit, color=colour, alpha=0.14, linewidth=0, label="3 σ")
        axes[k].plot(t, value, color=colour, label="estimate − truth")
        axes[k].set_ylabel(f"{name}  [{unit}]")
        axes[k].set_ylim(*_limits(value, limit))
    style.legend(axes[0])
    style.on_time(axes, signals["t"], run.spans)
    return style.svg(figure, "error of the estimate")


def tracking(run: Run) -> str | None:
    """Returns how far truth and odometry are off: lateral error, drift; None without truth."""
    signals = run.signals
    if not _known(signals.get("truth")):
        return None
    rows = list(_distances(run))
    if not rows:
        return None
    figure, axes = style.sheet(1, 2.5)
    for name, colour, distance in rows:
        t, value = style.thinned(signals["t"], distance * 100.0)
        axes[0].plot(t, value, color=style.STAND_IN[colour], label=name)
    axes[0].set_ylabel("distance to truth  [cm]")
    axes[0].set_ylim(bottom=0.0)
    style.legend(axes[0])
    style.on_time(axes, signals["t"], run.spans)
    return style.svg(figure, "distances to truth")


def _distances(run: Run) -> Iterator[tuple[str, str, np.ndarray]]:
    for name in ("reference", "odometry", "estimate"):
        pose = run.signals.get(name)
        if _known(pose):
            difference = pose[:, :2] - run.signals["truth"][:, :2]
            yield name, name, np.hypot(difference[:, 0], difference[:, 1])


def _limits(value: np.ndarray, limit: np.ndarray) -> tuple[float, float]:
    """Returns limits that show all errors and most of the bound, which may be huge at first."""
    top = 1.15 * max(
        float(np.nanmax(np.abs(value), initial=0.0)), float(np.nanpercentile(np.r_[limit, 0.0], 98))
    )
    return (-top, top) if top > 0 else (-1.0, 1.0)


def _known(pose: np.ndarray | None) -> TypeGuard[np.ndarray]:
    return pose is not None and bool(np.isfinite(pose).any())
