"""The figure of a run in real time: by how much its cycles began late."""

from __future__ import annotations

import numpy as np

from hilbed.report import style
from hilbed.report.run import Run

_CLASSES = np.geomspace(1e-2, 1e3, 51)  # ms, ten a decade


def lateness(run: Run) -> str | None:
    """Returns lateness over time and its histogram, missed deadlines in red; None in simulated time."""
    late = 1e3 * run.signals.get("realtime/lateness", np.empty(0))
    if not len(late):
        return None
    missed = run.signals["realtime/missed"].astype(bool)
    return _over_time(run, late, missed) + _histogram(late, missed)


def _over_time(run: Run, late: style.Column, missed: style.Column) -> str:
    t = run.signals["realtime/t"]
    figure, (axes,) = style.sheet(1, 2.2)
    axes.plot(t, late, ".", markersize=2, color=style.STAND_IN["estimate"])
    axes.plot(t[missed], late[missed], ".", markersize=4, color=style.STAND_IN["bad"])
    axes.set_yscale("log")
    axes.set_ylabel("late  [ms]")
    style.on_time([axes], run.signals["t"], run.spans)
    return style.svg(figure, "lateness of the cycles over time")


def _histogram(late: style.Column, missed: style.Column) -> str:
    figure, (axes,) = style.sheet(1, 2.2)
    kept = np.clip(late, _CLASSES[0], _CLASSES[-1])
    colours = [style.STAND_IN["estimate"], style.STAND_IN["bad"]]
    axes.hist([kept[~missed], kept[missed]], list(_CLASSES), stacked=True, color=colours)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylabel("cycles")
    axes.set_xlabel("late  [ms]")
    return style.svg(figure, "histogram of the lateness of the cycles")


def summary(run: Run) -> str:
    """Returns periods, missed deadlines and late answers in words."""
    part = run.verdict.get("realtime") or {}
    if not part.get("cycles"):
        return ""
    words = [f"{part['missed_deadlines']} of {part['cycles']} deadlines missed"]
    period = part["period"]
    if "mean" in period:
        spread = f"{1e3 * period['min']:.2f} … {1e3 * period['max']:.2f}"
        words.append(f"periods {spread} ms, mean {1e3 * period['mean']:.4f} ms")
    words += [f"{name}: {count} late answers" for name, count in part["late_answers"].items()]
    return "; ".join(words)
