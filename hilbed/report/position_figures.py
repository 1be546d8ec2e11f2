"""Figures of measured positions and yaws."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from hilbed.criteria.pose import wrapped
from hilbed.report import style
from hilbed.report.run import Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MOST = 2500  # points of a scatter: more are neither seen nor loaded quickly


def residuals(run: Run) -> str | None:
    """Returns measured minus true of all positions, and of yaws where there are any; None without any."""
    found = [kind for kind in ("position", "pose", "front") if len(run.signals.get(f"{kind}/t", ()))]
    if not found:
        return None
    figure, axes = style.sheet(len(found) + ("pose" in found), 0.8 + 1.8 * len(found))
    for one, kind in zip(axes, found, strict=False):
        t, difference = _known(run, kind)
        for k, (name, colour) in enumerate((("x", "estimate"), ("y", "odometry"))):
            _dots(one, t, 100.0 * difference[:, k], colour, name)
        one.set_ylabel(f"{'front' if kind == 'front' else 'position'}  [cm]")
    if "pose" in found:
        t, difference = _known(run, "pose")
        _dots(axes[-1], t, np.degrees(wrapped(difference[:, 2])), "estimate", "yaw")
        axes[-1].set_ylabel("yaw  [°]")
    style.legend(axes[0])
    style.on_time(axes, run.signals["t"], run.spans)
    return style.svg(figure, "position residuals")


def _known(run: Run, kind: str) -> tuple[np.ndarray, np.ndarray]:
    """Returns times and differences (n, size) of the readings that are numbers, thinned."""
    difference = run.signals[f"{kind}/measured"] - run.signals[f"{kind}/true"]
    kept = np.flatnonzero(np.isfinite(difference).all(axis=1))
    kept = kept[:: max(1, len(kept) // _MOST)]
    return run.signals[f"{kind}/t"][kept], difference[kept]


def _dots(axes: Axes, t: np.ndarray, values: np.ndarray, colour: str, name: str) -> None:
    axes.scatter(t, values, s=4, linewidths=0, alpha=0.7, color=style.STAND_IN[colour], label=name)
