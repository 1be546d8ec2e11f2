"""Figures of particle clouds, as they were recorded at a few instants."""

from __future__ import annotations

import numpy as np

from hilbed.criteria import Missing
from hilbed.report import style
from hilbed.report.run import Run

MOMENTS = 6
_NEAR = 1e-6  # s


def cloud_at(run: Run, t: float) -> np.ndarray:
    """Returns the cloud (M, 3) recorded at `t` (s); raises Missing where there is none."""
    times = run.signals["cloud/t"]
    k = int(np.argmin(np.abs(times - t)))
    if abs(times[k] - t) > _NEAR:
        raise Missing(f"no cloud was recorded at {t:g} s")
    cloud: np.ndarray = run.signals["cloud/particles"][k]
    return cloud


def belief(run: Run, t: float) -> str:
    """Returns the cloud at `t` (s) in the plane, and its x over yaw, with truth and mean."""
    from matplotlib.figure import Figure

    cloud, rows = cloud_at(run, t), run.signals["t"]
    now = int(np.argmin(np.abs(rows - t)))
    figure = Figure(figsize=(style.WIDTH, 2.9), layout="constrained")
    for axes, column, label in zip(figure.subplots(1, 2), (1, 2), ("y  [m]", "yaw  [rad]"), strict=True):
        axes.plot(cloud[:, 0], cloud[:, column], ".", markersize=2.5, color=style.STAND_IN["estimate"])
        for name, marker, colour in (("truth", "x", "bad"), ("estimate", "+", "odometry")):
            pose = run.signals[name][now]
            axes.plot(pose[0], pose[column], marker, markersize=8, color=style.STAND_IN[colour], label=name)
        axes.locator_params(axis="x", nbins=4)
        axes.set_xlabel("x  [m]")
        axes.set_ylabel(label)
    style.legend(axes, 2.0)
    return style.svg(figure, f"cloud at {t:g} s")


def clouds(run: Run) -> str | None:
    """Returns a few of the recorded clouds in the plane, each in its own colour; None without any."""
    times = run.signals.get("cloud/t", np.empty(0))
    if not len(times):
        return None
    figure, (axes,) = style.sheet(1, 3.6)
    axes.plot(*run.signals["truth"][:, :2].T, color=style.STAND_IN["muted"], linewidth=0.8)
    chosen = np.unique(np.linspace(0, len(times) - 1, MOMENTS).round().astype(int))
    colours = ("estimate", "odometry", "left", "right", "good", "bad")
    for k, colour in zip(chosen, colours, strict=False):
        x, y, _ = run.signals["cloud/particles"][k].T
        axes.plot(x, y, ".", markersize=2, color=style.STAND_IN[colour], label=f"{times[k]:g} s")
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("x  [m]")
    axes.set_ylabel("y  [m]")
    style.legend(axes, 2.0)
    return style.svg(figure, "clouds of particles")
