"""Figures of the bus: how full it is and how long frames take."""

from __future__ import annotations

import numpy as np

from hilbed.criteria import Missing
from hilbed.criteria.bus import load
from hilbed.report import style
from hilbed.report.run import Run

_MOST = 14  # identifiers that one figure can name


def bus_load(run: Run) -> str | None:
    """Returns the bus load over time; None without a bus."""
    if not len(run.signals.get("bus/t", ())):
        return None
    try:
        t, part = load(run.signals)
    except Missing:
        return None
    figure, axes = style.sheet(1, 2.4)
    axes[0].fill_between(t, 100 * part, step="post", color=style.STAND_IN["estimate"], alpha=0.2, linewidth=0)
    axes[0].step(t, 100 * part, where="post", color=style.STAND_IN["estimate"], linewidth=0.9)
    axes[0].set_ylim(0.0, 1.25 * float(100 * part.max()) or 1.0)
    axes[0].set_ylabel("bus load  [%]")
    style.on_time(axes, run.signals["t"], run.spans)
    return style.svg(figure, "bus load")


def latency(run: Run) -> str | None:
    """Returns median, 99th percentile and longest latency by identifier; None without a bus."""
    if not (run.signals.get("bus/t", np.empty(0)) >= 0).any():
        return None
    running = run.signals["bus/t"] >= 0
    if "bus/error" in run.signals:
        running &= run.signals["bus/error"] == 0
    identifiers, values = run.signals["bus/id"][running], 1e3 * run.signals["bus/latency"][running]
    found, counts = np.unique(identifiers, return_counts=True)
    found = np.sort(found[np.argsort(-counts)[:_MOST]])[::-1]
    rows = np.array([_marks(values[identifiers == one]) for one in found])
    figure, (axes,) = style.sheet(1, max(2.4, 0.9 + 0.21 * len(found)))
    places = np.arange(len(found))
    axes.hlines(places, rows[:, 0], rows[:, 2], color=style.STAND_IN["line"], linewidth=4)
    marks = (("median", "estimate"), ("99 %", "odometry"), ("longest", "bad"))
    for column, (name, colour) in enumerate(marks):
        axes.plot(rows[:, column], places, "o", markersize=4, color=style.STAND_IN[colour], label=name)
    axes.set_yticks(places, [f"0x{one:03X}" for one in found], family="monospace")
    axes.grid(axis="y", visible=False)
    axes.set_xlim(left=0.0)
    axes.set_xlabel("queued to last bit  [ms]")
    style.legend(axes, 2.0)
    return style.svg(figure, "latency of frames by identifier")


def _marks(values: np.ndarray) -> tuple[float, float, float]:
    return float(np.median(values)), float(np.percentile(values, 99)), float(values.max())
