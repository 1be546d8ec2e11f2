"""One look for all figures: colours with a meaning, thin axes, SVG that follows the page's theme.

Figures are drawn in stand-in colours, which the page's style sheet then gives their light and dark values.
"""

from __future__ import annotations

import logging
import re
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from io import StringIO
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np

from hilbed.report.run import Span
from hilbed.scene import COLOURS as SCENE_COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH = 5.7  # inches, 410 units of the SVG: text of 9.5 units can be read on a phone and is quiet on a desk


Column: TypeAlias = np.ndarray[Any, Any]


class Theme(NamedTuple):
    """A colour by day and by night."""

    light: str
    dark: str


COLOURS: dict[str, Theme] = {
    "ink": Theme("#15181d", "#e8eaed"),
    "muted": Theme("#667080", "#98a2b3"),
    "line": Theme("#d8dde4", "#343a45"),
    "truth": Theme("#15181d", "#f4f5f7"),
    "estimate": Theme("#1f6feb", "#62a4ff"),
    "odometry": Theme("#d9730d", "#f5a04a"),
    "reference": Theme("#9aa5b4", "#6d7889"),
    "left": Theme("#0e8a7d", "#36cfbd"),
    "right": Theme("#8b3fd1", "#c08bff"),
    "third": Theme("#b3701a", "#e0a860"),
    "bad": Theme("#d1293d", "#ff6b78"),
    "good": Theme("#1a7f43", "#4ac27b"),
    "shade": Theme("#e5a50a", "#e5b53a"),
}
STAND_IN = {name: f"#0a0b{16 + k:02x}" for k, name in enumerate(COLOURS)}
DRIVES = ("left", "right", "third")


def beacon_colour(name: str, brightness: float = 1.0) -> str:
    """Returns the colour of a beacon, darker where bright yellow would not be seen on white."""
    parts = SCENE_COLOURS.get(name, (0.6, 0.6, 0.6))
    return "#" + "".join(f"{round(255 * brightness * part):02x}" for part in parts)


_RC: dict[Any, Any] = {
    "svg.fonttype": "none",
    "svg.hashsalt": "hilbed",
    "font.size": 9.5,
    "font.family": "sans-serif",
    "axes.edgecolor": STAND_IN["muted"],
    "axes.labelcolor": STAND_IN["muted"],
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "axes.grid": True,
    "grid.color": STAND_IN["line"],
    "grid.linewidth": 0.5,
    "text.color": STAND_IN["ink"],
    "xtick.color": STAND_IN["muted"],
    "ytick.color": STAND_IN["muted"],
    "xtick.major.size": 0.0,
    "ytick.major.size": 0.0,
    "lines.linewidth": 1.1,
    "lines.solid_joinstyle": "round",
    "legend.frameon": False,
    "legend.handlelength": 1.4,
    "legend.borderaxespad": 0.0,
    "path.simplify_threshold": 0.3,
}


@contextmanager
def drawing() -> Iterator[None]:
    """Sets the look for what is drawn inside.

    What matplotlib has to say about its cache, or about axes that a broken run leaves empty, helps nobody.
    """
    logging.getLogger("matplotlib").setLevel(logging.ERROR)
    import matplotlib

    with matplotlib.rc_context(_RC), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


def sheet(rows: int, height: float, **options: Any) -> tuple[Figure, list[Axes]]:
    """Returns a figure of the common width with `rows` axes over one time axis; height in inches."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(WIDTH, height), layout="constrained")
    axes = figure.subplots(rows, 1, sharex=True, squeeze=False, **options)[:, 0]
    return figure, list(axes)


def on_time(axes: Sequence[Axes], t: np.ndarray, spans: Sequence[Span]) -> None:
    """Lays the axes over the time of the run and shades the disturbances, lettered on the first of them."""
    if len(t) > 1:
        axes[-1].set_xlim(t[0], t[-1])
    axes[-1].set_xlabel("t  [s]")
    last = t[-1] if len(t) else 0.0
    for span in spans:
        if span.start <= 0.0 and span.end >= last:
            continue  # all the time: there is nothing to tell it from
        for one in axes:
            one.axvspan(span.start, min(span.end, last), color=STAND_IN["shade"], alpha=0.16, linewidth=0)
        if span.start <= last:
            axes[0].annotate(
                span.letter, ((span.start + min(span.end, last)) / 2, 1.0), (0, 2),
                textcoords="offset points", xycoords=axes[0].get_xaxis_transform(), annotation_clip=False,
                ha="center", va="bottom", fontsize=8, fontweight="bold", color=STAND_IN["shade"],
            )  # fmt: skip


_ROW, _HANDLE = 70, 5  # characters that fit into a row of a legend, and that a line and its gaps take


def legend(axes: Axes, lift: float = 12.0) -> None:
    """Puts the legend above the axes, `lift` points up: over the letters of the disturbances.

    It is one row, or more where the names do not fit into one.
    """
    from matplotlib.transforms import ScaledTranslation

    place = axes.transAxes + ScaledTranslation(0.0, lift / 72, axes.figure.dpi_scale_trans)
    widths = [len(label) + _HANDLE for label in axes.get_legend_handles_labels()[1]]
    columns = len(widths) if sum(widths) <= _ROW else max(_ROW // max(widths), 1)
    axes.legend(
        loc="lower right", bbox_to_anchor=(1.0, 1.0), bbox_transform=place, ncols=columns, columnspacing=1.2
    )


def thinned(t: np.ndarray, *columns: np.ndarray, bins: int = 700) -> tuple[np.ndarray, ...]:
    """Returns t and columns (n,) with at most the lowest and highest value of the first column in each bin.

    What is left looks the same at the figure's width: peaks stay, and so do gaps of NaN.
    """
    size = len(t) // bins
    if size < 4:
        return (t, *columns)
    count = len(t) // size
    block = columns[0][: count * size].reshape(count, size)
    empty = np.isnan(block).all(axis=1)
    block = np.where(empty[:, None], 0.0, block)
    pair = np.sort(np.stack([np.nanargmin(block, axis=1), np.nanargmax(block, axis=1)], axis=1), axis=1)
    ends = np.arange(count * size, len(t))
    kept = np.unique(np.r_[(pair + size * np.arange(count)[:, None]).ravel(), ends])
    return (t[kept], *(column[kept] for column in columns))


def svg(figure: Figure, label: str) -> str:
    """Returns the figure as an `<svg>` element that scales with its place and takes the page's colours."""
    buffer = StringIO()
    nothing = dict.fromkeys(("Date", "Creator", "Format", "Type"))
    figure.savefig(buffer, format="svg", transparent=True, metadata=nothing)
    text = buffer.getvalue()
    text = text[text.index("<svg") :]
    for pattern, replacement in _CLEANING:
        text = re.sub(pattern, replacement, text, flags=re.DOTALL)
    text = re.sub(r' (?:d|x|y|transform)="[^"]*"', _rounded, text)
    text = text.replace("<svg ", f'<svg role="img" aria-label="{label}" ', 1)
    for name, stand_in in STAND_IN.items():
        text = text.replace(stand_in, f"var(--{name})")
    return text


# What matplotlib writes and a page does not want: metadata, global styles, sizes, fonts, ids that repeat.
_CLEANING = (
    (r"<metadata>.*?</metadata>\s*", ""),
    (r"<style.*?</style>\s*", ""),
    (r'(<svg [^>]*?) width="[^"]*" height="[^"]*"', r"\1"),
    (r' id="[a-zA-Z0-9.]+_\d+"', ""),
    (r"font-family: [^;\"]*; ?", ""),
    (r"font: ([^;\"]*px) [^;\"]*;", r"font-size: \1;"),
)


def _rounded(attribute: re.Match[str]) -> str:
    """Returns an attribute with two decimals: a hundredth of a unit is finer than any screen."""
    return re.sub(r"(\.\d\d)\d+", r"\1", attribute.group())
