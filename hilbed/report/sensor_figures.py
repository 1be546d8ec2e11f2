"""Figures of the readings and of what the estimator made of them."""

from __future__ import annotations

import numpy as np

from hilbed.criteria.pose import wrapped
from hilbed.report import style
from hilbed.report.run import Run

_KINDS = {"azimuth": (180_000 / np.pi, "mdeg"), "range": (100.0, "cm")}
_LEAST = 1e-2  # NIS below it is drawn there
_MOST = 2500  # points of a scatter: more are neither seen nor loaded quickly


def residuals(run: Run, kind: str) -> str | None:
    """Returns measured minus true of all readings of a kind, and how they are spread; None without any."""
    if not len(run.signals.get(f"{kind}/t", ())):
        return None
    scale, unit = _KINDS[kind]
    t, beacon = run.signals[f"{kind}/t"], run.signals[f"{kind}/beacon"]
    difference = run.signals[f"{kind}/measured"] - run.signals[f"{kind}/true"]
    residual = (wrapped(difference) if kind == "azimuth" else difference) * scale
    real = (beacon >= 0) & np.isfinite(residual)
    if not real.any():
        return None
    figure, (axes,) = style.sheet(1, 2.6)
    limit = 1.1 * float(np.percentile(np.abs(residual[real]), 99.5)) or 1.0
    kept = np.flatnonzero(real)[:: max(1, int(real.sum()) // _MOST)]
    axes.scatter(t[kept], residual[kept], s=4, linewidths=0, alpha=0.8, c=_colours(run, beacon[kept]))
    axes.set_ylim(-limit, limit)
    axes.set_ylabel(f"measured − true  [{unit}]")
    style.on_time([axes], run.signals["t"], run.spans)
    side = axes.inset_axes((1.01, 0.0, 0.13, 1.0), sharey=axes)
    bins = np.linspace(-limit, limit, 41).tolist()
    side.hist(residual[real], bins, orientation="horizontal", color=style.STAND_IN["estimate"], alpha=0.55)
    side.axis("off")
    return style.svg(figure, f"{kind} residuals")


def _colours(run: Run, beacons: np.ndarray) -> list[str]:
    """Returns a colour for each reading: its beacon's, a shade darker so that yellow can be seen."""
    table = [style.beacon_colour(beacon.colour, 0.8) for beacon in run.beacons]
    return [table[k] if k < len(table) else style.STAND_IN["estimate"] for k in beacons.tolist()]


def nis(run: Run) -> str | None:
    """Returns all innovations against the bound that 95 % of honest ones keep; None without any."""
    if not len(run.signals.get("nis/t", ())):
        return None
    from scipy.stats import chi2

    t, value = run.signals["nis/t"], np.maximum(run.signals["nis/value"], _LEAST)
    accepted, dof = run.signals["nis/accepted"].astype(bool), run.signals["nis/dof"]
    figure, (axes,) = style.sheet(1, 2.6)
    for name, chosen, colour in (("accepted", accepted, "estimate"), ("rejected", ~accepted, "bad")):
        if not chosen.any():
            continue
        kept = np.flatnonzero(chosen)[:: max(1, int(chosen.sum()) // _MOST)]
        axes.scatter(
            t[kept], value[kept], s=5, linewidths=0, alpha=0.75, color=style.STAND_IN[colour],
            label=f"{name} ({int(chosen.sum())})",
        )  # fmt: skip
    bound = float(chi2.ppf(0.95, np.bincount(dof.astype(int)).argmax()))
    axes.axhline(bound, color=style.STAND_IN["muted"], linewidth=0.9, linestyle=(0, (4, 2)), label="95 %")
    axes.set_yscale("log")
    axes.set_ylabel("NIS")
    style.legend(axes)
    style.on_time([axes], run.signals["t"], run.spans)
    return style.svg(figure, "normalised innovations squared")
