"""The page of a swept degradation: one figure, a frame at each value, a table."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from math import isfinite
from typing import TYPE_CHECKING

import numpy as np

from hilbed.report import page, style
from hilbed.vision_kit.dataset import png
from hilbed.vision_kit.degradation import EFFECTS, Sweep, Variant
from hilbed.vision_kit.labelled import LabelledShot

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_COLOURS = ("right", "left", "third", "estimate", "odometry")
_SHEET = """
.shots.strips { grid-template-columns: minmax(0, 1fr); gap: 12px; }
.scroll th { white-space: nowrap; }
"""


def write(sweep: Sweep, frames: Sequence[LabelledShot]) -> str:
    """Returns the whole page; frames: one at each value."""
    with style.drawing():
        drawn = figure(sweep)
    runs = sum(len(variant.results) for variant in sweep.variants)
    failed = runs - sum(variant.passed for variant in sweep.variants)
    word, kind = (f"{failed} of {runs} failed", "bad") if failed else ("all passed", "good")
    head = (
        f'<header class="{kind}"><div><h1>{escape(sweep.scenario)}<small> over {escape(sweep.path)}</small>'
        f'<span class="pill">{word}</span></h1></div></header>\n'
    )
    note = "a dot is a run, the line is the mean over the seeds; a cross is a run that broke off"
    cards = (
        page.card("From the camera to the wheels", drawn, note)
        + page.card("What the camera sees", _shots(sweep, frames), "the first frame, with each value")
        + page.card("Numbers", _table(sweep), "mean over the seeds", wide=True)
    )
    title = f"{sweep.scenario} over {sweep.path}"
    return page.whole(title, f'<style>{_SHEET}</style>{head}<div class="grid">{cards}</div>')


def figure(sweep: Sweep) -> str:
    """Returns the effects over the values, one above the other."""
    x, labels = _places(sweep)
    sheet, axes = style.sheet(len(EFFECTS), 1.35 * len(EFFECTS))
    for one, effect, colour in zip(axes, EFFECTS, _COLOURS, strict=True):
        numbers = [variant.numbers(effect) for variant in sweep.variants]
        ink = style.STAND_IN[colour]
        for at, values in zip(x, numbers, strict=True):
            one.plot([at] * len(values), values, "o", markersize=3, alpha=0.55, color=ink, linewidth=0)
        one.plot(x, [_mean(values) for values in numbers], color=ink)
        unit = f"  [{effect.unit}]" if effect.unit else ""
        one.set_title(f"{effect.title}{unit}", loc="left", fontsize=9.5, color=style.STAND_IN["muted"], pad=3)
        highest = max((value for values in numbers for value in values if isfinite(value)), default=1.0)
        one.set_ylim(0, 1.15 * highest or 1.0)
        _crosses(one, x, sweep.variants)
    axes[-1].set_xticks(x, labels)
    axes[-1].set_xlabel(sweep.path)
    return style.svg(sheet, "effects of the degradation")


def _crosses(axes: Axes, x: Sequence[float], variants: Sequence[Variant]) -> None:
    for at, variant in zip(x, variants, strict=True):
        if any(result.status > 1 for result in variant.results):
            axes.plot(at, 0.0, "x", color=style.STAND_IN["bad"], clip_on=False)


def _places(sweep: Sweep) -> tuple[list[float], list[str]]:
    """Returns where the values lie: by their size, or evenly where they are words or repeat."""
    labels = [variant.value for variant in sweep.variants]
    try:
        sizes = [float(label) for label in labels]
    except ValueError:
        sizes = []
    if len(set(sizes)) != len(labels) or not all(map(isfinite, sizes)):
        sizes = [float(k) for k in range(len(labels))]
    return sizes, labels


def _mean(values: Sequence[float]) -> float:
    known = [value for value in values if isfinite(value)]
    return float(np.mean(known)) if known else float("nan")


def _shots(sweep: Sweep, frames: Sequence[LabelledShot]) -> str:
    shown = "".join(
        _shot(sweep.setting(variant), frame) for variant, frame in zip(sweep.variants, frames, strict=True)
    )
    return f'<div class="shots strips">{shown}</div>'


def _shot(caption: str, frame: LabelledShot) -> str:
    height, width = frame.shot.image.shape[:2]
    data = page.base64(png(frame.shot.image))
    picture = f'<image width="{width}" height="{height}" href="data:image/png;base64,{data}"/>'
    return (
        f'<figure><svg role="img" aria-label="{escape(caption)}" viewBox="0 0 {width} {height}">{picture}'
        f"</svg><figcaption>{escape(caption)}</figcaption></figure>"
    )


def _table(sweep: Sweep) -> str:
    heads = "".join(f'<th class="number">{escape(effect.title)}</th>' for effect in EFFECTS)
    rows = ""
    for variant in sweep.variants:
        cells = "".join(
            f'<td class="number">{page.number(_mean(variant.numbers(effect)))} {effect.unit}</td>'
            for effect in EFFECTS
        )
        met = f"{variant.passed} of {len(variant.results)}"
        rows += f'<tr><th>{escape(variant.value)}</th>{cells}<td class="number">{met}</td></tr>'
    key = sweep.path.rpartition(".")[2]
    head = f'<tr><th>{escape(key)}</th>{heads}<th class="number">passed</th></tr>'
    return f'<div class="scroll"><table><tbody>{head}{rows}</tbody></table></div>'
