"""Figures of states and commands over time, as papers show them."""

from __future__ import annotations

import numpy as np

from hilbed.report import style
from hilbed.report.run import Run

_STATES = (("x  [m]", 0), ("y  [m]", 1), ("yaw  [rad]", 2))
_SHOWN = ("reference", "truth", "estimate")


def states(run: Run) -> str:
    """Returns x, y and yaw of reference, truth and estimate."""
    signals = run.signals
    figure, axes = style.sheet(3, 4.4)
    for axis, (label, column) in zip(axes, _STATES, strict=True):
        for name in _SHOWN:
            values = signals[name][:, column]
            if np.isfinite(values).any():
                t, thin = style.thinned(signals["t"], values)
                axis.plot(t, _unjoined(thin) if column == 2 else thin, color=style.STAND_IN[name], label=name)
        axis.set_ylabel(label)
    style.legend(axes[0])
    style.on_time(axes, signals["t"], run.spans)
    return style.svg(figure, "states over time")


def commands(run: Run) -> str:
    """Returns both components of the command."""
    signals = run.signals
    tricycle = "kind: tricycle" in run.scenario
    labels = ("v  [m/s]", "γ  [rad]" if tricycle else "ω  [rad/s]")
    figure, axes = style.sheet(2, 3.2)
    for axis, label, values in zip(axes, labels, signals["command"].T, strict=True):
        t, thin = style.thinned(signals["t"], values)
        axis.plot(t, thin, color=style.STAND_IN["estimate"])
        axis.set_ylabel(label)
    style.on_time(axes, signals["t"], run.spans)
    return style.svg(figure, "commands over time")


def landmark(run: Run) -> str | None:
    """Returns the estimated distance of the landmarks beside the true one; None where none is estimated."""
    signals = run.signals
    if "landmark_distance" not in signals:
        return None
    figure, (axes,) = style.sheet(1, 2.2)
    t, thin = style.thinned(signals["t"], signals["landmark_distance"])
    axes.plot(t, thin, color=style.STAND_IN["estimate"], label="estimate")
    true = np.hypot(*(signals["beacons"][1] - signals["beacons"][0]))
    axes.axhline(true, color=style.STAND_IN["truth"], label="truth")
    axes.set_ylabel("l  [m]")
    style.legend(axes)
    style.on_time([axes], signals["t"], run.spans)
    return style.svg(figure, "distance of the landmarks")


def observability(run: Run) -> str | None:
    """Returns how well bearings tell the state along the true path; None where no landmark is looked for.

    The determinant of the four-state rank condition without steering: it passes through zero where the
    robot's axis passes through a landmark.
    """
    signals = run.signals
    if "landmark_distance" not in signals:
        return None
    from hilbed.estimation.observability import full_determinant

    true = np.hypot(*(signals["beacons"][1] - signals["beacons"][0]))
    path = np.column_stack((signals["truth"], np.full(len(signals["t"]), true)))
    figure, (axes,) = style.sheet(1, 2.2)
    t, thin = style.thinned(signals["t"], full_determinant(path))
    axes.plot(t, thin, color=style.STAND_IN["truth"])
    axes.axhline(0.0, color=style.STAND_IN["bad"], linewidth=0.8)
    axes.set_yscale("symlog", linthresh=1e-3)
    axes.set_ylabel("determinant  [1/m⁵]")
    style.on_time([axes], signals["t"], run.spans)
    return style.svg(figure, "observability along the path")


def _unjoined(yaw: style.Column) -> style.Column:
    """Returns yaw with a gap where it wraps."""
    jumps = np.flatnonzero(np.abs(np.diff(yaw)) > np.pi) + 1
    gaps = yaw.copy()
    gaps[jumps] = np.nan
    return gaps
