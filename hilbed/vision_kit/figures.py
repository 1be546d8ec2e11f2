"""Figures of a trial: what is found and how exactly, against what may be in the way."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import degrees, isfinite, pi
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from hilbed.report import style
from hilbed.scene import BeaconSpec
from hilbed.types import Array
from hilbed.vision_kit.matching import Sighting, Stray
from hilbed.vision_kit.trial import Trial

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BINS = 10
MOST = 2500  # points of a scatter
MDEG = 180_000 / pi
_COLOUR = style.STAND_IN


class Axis(NamedTuple):
    """What recall and precision are drawn over: its label, the value, which beacons count for recall."""

    label: str
    value: Callable[[Sighting | Stray], float]
    counts: Callable[[Trial, Sighting], bool]


AXES = (
    Axis("distance  [m]", lambda one: one.distance, lambda trial, one: trial.rules.sees(one) and not one.cut),
    Axis(
        "visible part of the beacon",
        lambda one: one.visible,
        lambda trial, one: trial.rules.reaches(one) and not one.cut,
    ),
    Axis("brightness of the frame", lambda one: one.light, lambda trial, one: trial.rules.due(one)),
)


def rates(trial: Trial, axis: Axis) -> str | None:
    """Returns recall and precision over an axis, above the number of beacons in each bin."""
    if not trial.sightings:
        return None
    bins = _Bins([axis.value(one) for one in trial.sightings])
    due = [one for one in trial.sightings if axis.counts(trial, one)]
    right = [one for one in trial.sightings if one.found and not one.mistaken]
    made: list[Sighting | Stray] = [*(one for one in trial.sightings if one.found), *trial.strays]
    figure, (axes,) = style.sheet(1, 2.5)
    count = bins.count(due, axis)
    _columns(axes, bins, count)
    for name, part, whole, colour in (
        ("recall", [one for one in due if one.found], due, "estimate"),
        ("precision", right, made, "left"),
    ):
        share = bins.share(bins.count(part, axis), bins.count(whole, axis))
        known = np.isfinite(share)
        axes.plot(
            bins.middles[known], 100 * share[known], "o-", markersize=3.5, color=_COLOUR[colour], label=name
        )
    axes.set_ylim(-3, 103)
    axes.set_ylabel("%")
    axes.set_xlabel(axis.label)
    style.legend(axes, 2.0)
    return style.svg(figure, f"recall and precision over {axis.label.split('  ')[0]}")


class _Bins:
    """Ten bins of one width over values; one if all are the same."""

    def __init__(self, values: Sequence[float]) -> None:
        low, high = min(values), max(values)
        if high - low < 1e-3:
            low, high = low - 0.05, high + 0.05
        self.edges = np.linspace(low, high + 1e-9, BINS + 1)
        self.middles = 0.5 * (self.edges[1:] + self.edges[:-1])
        self.width = float(self.edges[1] - self.edges[0])

    def count(self, ones: Sequence[Sighting] | Sequence[Sighting | Stray], axis: Axis) -> Array:
        values = [axis.value(one) for one in ones]
        return np.histogram([v for v in values if isfinite(v)], self.edges)[0].astype(float)

    @staticmethod
    def share(part: Array, whole: Array) -> Array:
        return np.asarray(np.divide(part, whole, out=np.full(len(whole), np.nan), where=whole > 0))


def _columns(axes: Axes, bins: _Bins, count: Array) -> None:
    """Draws quietly how many beacons there are: a rate of few says little."""
    beside = axes.twinx()
    beside.bar(bins.middles, count, 0.92 * bins.width, color=_COLOUR["line"], alpha=0.55, linewidth=0)
    beside.set_ylim(0, 3.2 * max(float(count.max()), 1.0))
    beside.axis("off")
    axes.set_zorder(beside.get_zorder() + 1)
    axes.patch.set_visible(False)


def over_distance(trial: Trial, beacons: Sequence[BeaconSpec]) -> str | None:
    """Returns the azimuth's error over distance, with mean and spread in each bin."""
    return _errors(trial, beacons, lambda one: one.distance, "distance  [m]")


def over_azimuth(trial: Trial, beacons: Sequence[BeaconSpec]) -> str | None:
    """Returns the azimuth's error over the azimuth, left of the image on the left."""
    return _errors(trial, beacons, lambda one: -degrees(one.azimuth), "right of the camera's axis  [°]")


def _errors(
    trial: Trial, beacons: Sequence[BeaconSpec], over: Callable[[Sighting], float], label: str
) -> str | None:
    found = [one for one in trial.sightings if one.found]
    if not found:
        return None
    figure, (axes,) = style.sheet(1, 2.5)
    error = MDEG * np.array([one.error for one in found])
    colours = [style.beacon_colour(str(beacons[one.beacon].colour), 0.8) for one in found]
    _spread(axes, np.array([over(one) for one in found]), error, colours)
    limit = 1.15 * float(np.percentile(np.abs(error), 99)) or 1.0
    axes.set_ylim(-limit, limit)
    axes.set_xlabel(label)
    axes.set_ylabel("error  [mdeg]")
    style.legend(axes, 2.0)
    return style.svg(figure, f"azimuth errors over {label.partition('  ')[0]}")


def pixels(trial: Trial) -> str | None:
    """Returns how the azimuth's error is spread in pixels."""
    error = np.array([one.error_px for one in trial.sightings if one.found])
    error = error[np.isfinite(error)]
    if not error.size:
        return None
    figure, (axes,) = style.sheet(1, 2.5)
    limit = 1.15 * float(np.percentile(np.abs(error), 99)) or 0.01
    bins = np.linspace(-limit, limit, 51).tolist()
    axes.hist(np.clip(error, -limit, limit), bins, color=_COLOUR["left"], alpha=0.55)
    axes.axvline(float(error.mean()), color=_COLOUR["ink"], label=f"mean {error.mean():+.2g} px")
    axes.set_xlim(-limit, limit)
    axes.set_ylabel("azimuths")
    axes.set_xlabel(f"error  [px], standard deviation {error.std():.2g}")
    style.legend(axes, 2.0)
    return style.svg(figure, "azimuth errors in pixels")


def _spread(axes: Axes, x: Array, error: Array, colours: Sequence[str]) -> None:
    kept = slice(None, None, max(1, len(x) // MOST))
    axes.scatter(x[kept], error[kept], s=4, linewidths=0, alpha=0.7, c=colours[kept])
    edges = np.linspace(x.min(), x.max() + 1e-9, BINS + 1)
    which = np.digitize(x, edges) - 1
    chosen = [error[which == k] for k in range(BINS)]
    full = [k for k in range(BINS) if chosen[k].size > 2]
    middle = 0.5 * (edges[1:] + edges[:-1])[full]
    mean = np.array([chosen[k].mean() for k in full])
    std = np.array([chosen[k].std() for k in full])
    ink = _COLOUR["ink"]
    axes.fill_between(middle, mean - std, mean + std, color=ink, alpha=0.12, linewidth=0, label="± 1 std")
    axes.plot(middle, mean, color=ink, linewidth=1.2, label="mean")


def normalised(trial: Trial) -> str | None:
    """Returns how errors over their stated standard deviations are spread, beside the normal distribution."""
    values = np.array([one.error / one.std for one in trial.sightings if one.found])
    if not values.size:
        return None
    figure, (axes,) = style.sheet(1, 2.5)
    shown = np.clip(values, -5, 5)
    axes.hist(shown, np.linspace(-5, 5, 51).tolist(), density=True, color=_COLOUR["estimate"], alpha=0.55)
    x = np.linspace(-5, 5, 201)
    normal = np.exp(-0.5 * x * x) / np.sqrt(2 * pi)
    axes.plot(x, normal, color=_COLOUR["ink"], linestyle=(0, (4, 2)), label="as stated")
    axes.set_xlim(-5, 5)
    axes.set_yticks([])
    axes.set_xlabel("error / stated standard deviation")
    style.legend(axes, 2.0)
    return style.svg(figure, "normalised errors")


def times(trial: Trial) -> str | None:
    """Returns how long frames have taken, with percentiles."""
    if not trial.seconds:
        return None
    ms = 1000 * np.array(trial.seconds)
    figure, (axes,) = style.sheet(1, 2.5)
    last = 1.15 * float(np.percentile(ms, 99))
    axes.hist(np.clip(ms, 0, last), np.linspace(0, last, 51).tolist(), color=_COLOUR["estimate"], alpha=0.55)
    for part, dash in ((50, (0, ())), (95, (0, (4, 2))), (99, (0, (1, 2)))):
        value = float(np.percentile(ms, part))
        label = f"{part} %: {value:.3g} ms"
        axes.axvline(value, color=_COLOUR["ink"], linewidth=1.0, linestyle=dash, label=label)
    axes.set_xlim(0, last)
    axes.set_ylabel("frames")
    axes.set_xlabel("time of a frame  [ms]")
    style.legend(axes, 2.0)
    return style.svg(figure, "time of a frame")
