"""Attitude observers from many first guesses beside their closed forms: Pliego-Jiménez (2023)."""

from __future__ import annotations

import numpy as np
import yaml

from hilbed.criteria.pose import wrapped
from hilbed.paper.catalogue import Figure
from hilbed.paper.drawings import Runs, longest
from hilbed.paper.drawings.overlays import COLOURS
from hilbed.paper.tables import rows
from hilbed.report import style
from hilbed.report.run import Run

LEAST = 1e-10  # rad: smaller errors are drawn there


def fan(runs: Runs, _: Figure) -> str | None:
    """Returns the yaw errors in magnitude, each over the law that it should follow."""
    figure, (axes,) = style.sheet(1, 3.0)
    for k, (name, run) in enumerate(runs.items()):
        t = run.signals["t"]
        colour = style.STAND_IN[COLOURS[k % len(COLOURS)]]
        thin_t, law = style.thinned(t, _shown(closed_form(run)))
        axes.plot(thin_t, law, color=style.STAND_IN["reference"], linewidth=4.0, alpha=0.6)
        thin_t, error = style.thinned(t, _shown(yaw_error(run)))
        axes.plot(thin_t, error, color=colour, label=name)
    axes.plot([], [], color=style.STAND_IN["reference"], linewidth=4.0, alpha=0.6, label="law")
    axes.set_yscale("log")
    axes.set_ylabel("|yaw error|  [rad]")
    style.legend(axes, 2.0)
    style.on_time([axes], longest(runs), ())
    return style.svg(figure, "yaw errors from many first guesses") + _table(runs)


def _table(runs: Runs) -> str:
    """Returns the last yaw error of each run beside that of its law, and how far it ever is from the law."""
    body = [
        (name, *(f"{number:.3g}" for number in (yaw_error(run)[-1], closed_form(run)[-1], departure(run))))
        for name, run in runs.items()
    ]
    return rows(("yaw error, rad", "at the end", "law", "largest departure"), body)


def departure(run: Run) -> float:
    """Returns how far the yaw error departs from its law at most, rad."""
    return float(np.abs(wrapped(yaw_error(run) - closed_form(run))).max())


def _shown(error: np.ndarray) -> np.ndarray:
    return np.asarray(np.maximum(np.abs(error), LEAST))


def yaw_error(run: Run) -> np.ndarray:
    """Returns the estimated minus the true yaw (N,), rad."""
    return np.asarray(wrapped(run.signals["estimate"][:, 2] - run.signals["truth"][:, 2]))


def closed_form(run: Run) -> np.ndarray:
    """Returns the yaw error (N,) that the observer's law gives from its first guess, rad.

    On SO(2) and on the circle tan(e/2) decays as exp(−α ∫ν²); the global one's Θ̃, in the robot's frame and
    as a complex number exp(ie₀) − 1 at first, decays as exp(−g ∫ν²).
    """
    spec = yaml.safe_load(run.scenario)["estimator"]
    e0 = -float(spec["heading_error"])
    t, v = run.signals["t"], run.signals["command"][:, 0]
    decay = np.exp(-spec["gain"] * np.r_[0.0, np.cumsum(v[:-1] ** 2 * np.diff(t))])
    if spec["form"] == "global":
        return np.asarray(np.angle(1.0 + (np.exp(1j * e0) - 1.0) * decay))
    return np.asarray(2.0 * np.arctan(np.tan(e0 / 2) * decay))
