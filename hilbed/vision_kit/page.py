"""The page of a trial: numbers, figures and the worst frames, in one file."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from html import escape
from typing import Any

from hilbed.report import page
from hilbed.vision.judging import MEASURES
from hilbed.vision_kit import figures, pictures
from hilbed.vision_kit.studio import Subject
from hilbed.vision_kit.trial import Trial

_SHEET = """
.metrics th, .scroll th { white-space: nowrap; }
.shots.strips { grid-template-columns: minmax(0, 1fr); gap: 14px; }
.strip { display: flex; gap: 10px; align-items: stretch; }
.strip svg:first-child { flex: 1 1 0; min-width: 0; }
.strip svg + svg { flex: 0 0 auto; width: 13%; }
.shots line.true, .shots line.found { mix-blend-mode: normal; stroke-dasharray: none; stroke-width: 1; }
.strip svg + svg line { stroke-width: .4; }
.strip svg + svg text { display: none; }
.shots image { image-rendering: pixelated; }
.shots line.true { stroke: #00a03c; } .shots line.found { stroke: #e11e32; }
.shots text.true { fill: #2fd56f; } .shots text.found { fill: #ff6b78; } .shots text { font-size: 11px; }
"""


def write(subject: Subject, trial: Trial, verdict: Mapping[str, Any], scenario: str) -> str:
    """Returns the whole page; scenario: its resolved text."""
    from hilbed.report import style

    with style.drawing():
        cards = _figures(subject, trial, verdict)
    body = (
        _banner(verdict)
        + f'<div class="grid">{_numbers(verdict)}{cards}{_pictures(trial)}'
        + page.card("Scenario", f"<pre>{escape(scenario)}</pre>", "resolved: every default written out", True)
        + "</div>"
    )
    return page.whole(f"vision: {verdict['scenario']}", f"<style>{_SHEET}</style>{body}")


def _banner(verdict: Mapping[str, Any]) -> str:
    word, kind = ("passed", "good") if verdict["passed"] else ("failed", "bad")
    reason = f'<p class="reason">{escape(str(verdict["reason"]))}</p>' if verdict["reason"] else ""
    measures = verdict["measures"]
    facts = [
        ("azimuth", measures["azimuth_std_mdeg"], "mdeg"),
        ("recall", _percent(measures["recall"]), "%"),
        ("precision", _percent(measures["precision"]), "%"),
        ("a frame", measures["time_p50_ms"], "ms"),
    ]
    tiles = "".join(
        f"<div><dt>{name}</dt><dd>{_short(value)}<small> {unit}</small></dd></div>"
        for name, value, unit in facts
    )
    about = f"{verdict['detector']} on {int(measures['frames'])} frames, seed {verdict['seed']}"
    return (
        f'<header class="{kind}"><div><h1>{escape(str(verdict["scenario"]))}<small> {escape(about)}</small>'
        f'<span class="pill">{word}</span></h1>{reason}</div><dl>{tiles}</dl></header>\n'
    )


def _percent(value: float | None) -> float | None:
    return None if value is None else 100 * value


def _shown(value: float | None) -> str:
    return "none" if value is None else page.number(value)


def _short(value: float | None) -> str:
    return "none" if value is None else f"{value:.3g}"


def _numbers(verdict: Mapping[str, Any]) -> str:
    rows = "".join(
        f'<tr><th>{name}</th><td class="number">{_shown(value)} {MEASURES[name].unit}</td>'
        f'<td class="about">{escape(MEASURES[name].about)}</td></tr>'
        for name, value in verdict["measures"].items()
    )
    table = f'<div class="scroll"><table class="metrics"><tbody>{rows}</tbody></table></div>'
    return page.card("Criteria", page.criteria_table(verdict["criteria"])) + page.card("Measures", table)


def _figures(subject: Subject, trial: Trial, verdict: Mapping[str, Any]) -> str:
    titles = ("Found, by distance", "Found, by what is visible", "Found, by light")
    found = [
        page.card(title, figures.rates(trial, axis), "grey: how many beacons")
        for title, axis in zip(titles, figures.AXES, strict=True)
    ]
    return "".join(
        [
            page.card("Error of the azimuth, by distance", figures.over_distance(trial, subject.beacons)),
            page.card("Error of the azimuth, by direction", figures.over_azimuth(trial, subject.beacons)),
            page.card("Error of the azimuth, in pixels", figures.pixels(trial)),
            page.card("Is the stated standard deviation right?", figures.normalised(trial)),
            *found,
            page.card("Time of a frame", figures.times(trial)),
            page.card("By value", _varied(verdict), wide=True),
            page.card("Wrong identities", _identities(trial)),
            page.card("Frames without an answer", _failures(trial)),
        ]
    )


_SHOWN = (
    "recall", "precision", "azimuth_bias_mdeg", "azimuth_std_mdeg", "normalised_rms", "wrong_identities",
    "time_p50_ms",
)  # fmt: skip


def _varied(verdict: Mapping[str, Any]) -> str | None:
    """Returns the measures with each value of `--vary`; None without it."""
    if "varied" not in verdict:
        return None
    head = "".join(f'<th class="number">{name}</th>' for name in _SHOWN)
    rows = "".join(
        f"<tr><th>{escape(setting)}</th>"
        + "".join(f'<td class="number">{_shown(measures[name])}</td>' for name in _SHOWN)
        + "</tr>"
        for setting, measures in verdict["varied"].items()
    )
    return f'<div class="scroll"><table><tbody><tr><th></th>{head}</tr>{rows}</tbody></table></div>'


def _identities(trial: Trial) -> str | None:
    wrong = Counter((one.beacon, one.named) for one in trial.sightings if one.mistaken)
    rows = "".join(
        f'<tr><th>beacon {true} taken for {named}</th><td class="number">{count}</td></tr>'
        for (true, named), count in wrong.most_common()
    )
    return f'<div class="scroll"><table><tbody>{rows}</tbody></table></div>' if rows else None


def _failures(trial: Trial) -> str | None:
    rows = "".join(
        f"<tr><th>frame {frame}</th><td><pre>{escape(why)}</pre></td></tr>"
        for frame, why in trial.failed.items()
    )
    return f'<div class="scroll"><table><tbody>{rows}</tbody></table></div>' if rows else None


def _pictures(trial: Trial) -> str:
    shown = "".join(pictures.figure(picture, trial.rules) for picture in trial.worst)
    note = "green from above: true axis and beacon; red from below: what was found; right: a close-up"
    body = f'<div class="shots strips">{shown}</div>' if shown else None
    return page.card("Worst frames", body, note, wide=True)
