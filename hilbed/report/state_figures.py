"""Figures of states and commands over time, as papers show them."""

from __future__ import annotations

import numpy as np

from hilbed.report import style
from hilbed.report.run import Run

_STATES = (("x  [m]", 0), ("y  [m]", 1), ("yaw  [rad]", 2))
_LEAST = 1e-12  # determinants and singular values below it, and those on a landmark, are drawn there
_POINTS = 600  # of a path at which the rank is looked at
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
                axis.plot(t, unjoined(thin) if column == 2 else thin, color=style.STAND_IN[name], label=name)
        axis.set_ylabel(label)
    style.legend(axes[0])
    style.on_time(axes, signals["t"], run.spans)
    return style.svg(figure, "states over time")


def commands(run: Run) -> str:
    """Returns both components of the command."""
    signals = run.signals
    figure, axes = style.sheet(2, 3.2)
    for axis, label, values in zip(axes, command_labels(run), signals["command"].T, strict=True):
        t, thin = style.thinned(signals["t"], values)
        axis.plot(t, thin, color=style.STAND_IN["estimate"])
        axis.set_ylabel(label)
    style.on_time(axes, signals["t"], run.spans)
    return style.svg(figure, "commands over time")


def command_labels(run: Run) -> tuple[str, str]:
    """Returns what the two components of a command are, by the kind of robot."""
    return "v  [m/s]", "γ  [rad]" if "kind: tricycle" in run.scenario else "ω  [rad/s]"


def landmark(run: Run) -> str | None:
    """Returns the estimated distance of the landmarks beside the true one; None where none is estimated."""
    signals = run.signals
    if not len(signals.get("landmark_distance", ())):
        return None
    figure, (axes,) = style.sheet(1, 2.2)
    t, thin = style.thinned(signals["t"], signals["landmark_distance"])
    axes.plot(t, thin, color=style.STAND_IN["estimate"], label="estimate")
    axes.axhline(landmark_distance(run), color=style.STAND_IN["truth"], linestyle=":", label="truth")
    axes.set_ylabel("l  [m]")
    style.legend(axes)
    style.on_time([axes], signals["t"], run.spans)
    return style.svg(figure, "distance of the landmarks")


def landmark_distance(run: Run) -> float:
    """Returns the true distance of the two landmarks, m."""
    return float(np.hypot(*(run.signals["beacons"][1] - run.signals["beacons"][0])))


def observability(run: Run) -> str | None:
    """Returns how well bearings tell the state along the true path; None where no landmark is looked for.

    Above the four-state rank condition without steering, |det|; below the smallest singular value of the
    gradients without and with steering. Both are near zero where the robot's axis passes through a landmark.
    """
    signals = run.signals
    if not len(signals.get("landmark_distance", ())):
        return None
    from hilbed.estimation.observability import full_determinant, full_rows
    from hilbed.estimation.sights import Survey

    true, step = landmark_distance(run), max(1, len(signals["t"]) // _POINTS)
    path = np.column_stack((signals["truth"], np.full(len(signals["t"]), true)))[::step]
    t = signals["t"][::step]
    figure, axes = style.sheet(2, 3.6)
    axes[0].plot(t, np.fmax(np.abs(full_determinant(path)), _LEAST), color=style.STAND_IN["truth"])
    axes[0].set_ylabel("|det|  [1/m⁵]")
    for steering, colour, label in ((False, "truth", "straight on"), (True, "estimate", "steering")):
        values = [_smallest(full_rows(Survey(*state), steering)) for state in path.tolist()]
        axes[1].plot(t, np.fmax(values, _LEAST), color=style.STAND_IN[colour], label=label)
    axes[1].set_ylabel("smallest σ")
    for axis in axes:
        axis.set_yscale("log")
        axis.minorticks_off()
    style.legend(axes[1], 2.0)
    style.on_time(axes, signals["t"], run.spans)
    return style.svg(figure, "observability along the path")


def _smallest(rows: style.Column) -> float:
    """Returns the smallest singular value; NaN on a landmark, whence nothing has a direction."""
    finite = bool(np.isfinite(rows).all())
    return float(np.linalg.svd(rows, compute_uv=False)[-1]) if finite else float("nan")


def unjoined(yaw: style.Column) -> style.Column:
    """Returns yaw (N,) with a gap where it wraps."""
    jumps = np.flatnonzero(np.abs(np.diff(yaw)) > np.pi) + 1
    gaps = yaw.copy()
    gaps[jumps] = np.nan
    return gaps
