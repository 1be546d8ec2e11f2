"""The page around the figures: banner, tables, camera frames; plain HTML without a script."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Mapping
from html import escape
from math import inf
from typing import Any
from urllib.parse import quote

from hilbed.criteria import METRICS, window_text
from hilbed.record.folder import ATTRIBUTION, CAN, DETECTORS, MCAP, SIGNALS, VERDICT
from hilbed.report.run import Run, Shot, Span
from hilbed.report.style import COLOURS, Theme
from hilbed.tally import ABOUT

_PARTS = ("#6b8afd", "#42b3a4", "#e2a03f", "#d9698a", "#9a7bd8", "#5fa8d3", "#8fb04e", "#9aa5b4", "#c3c9d2")


def card(title: str, body: str | None, note: str = "", wide: bool = False) -> str:
    """Returns a section of the page; nothing where there is no body."""
    if body is None:
        return ""
    head = f"<h2>{escape(title)}</h2>" + (f'<p class="note">{note}</p>' if note else "")
    return f'<section class="card{" wide" if wide else ""}">{head}{body}</section>\n'


def banner(run: Run) -> str:
    """Returns the head of the page: what ran, whether it passed, and why not."""
    verdict = run.verdict
    word, kind = ("passed", "good") if verdict["passed"] else ("failed", "bad")
    reason = f'<p class="reason">{escape(str(verdict["reason"]))}</p>' if verdict.get("reason") else ""
    away = [f"{name} {kind}" for name, kind in verdict.get("nodes", {}).items() if kind != "simulated"]
    drives = f'<p class="reason">drives: {escape(", ".join(away))}</p>' if away else ""
    facts = [
        ("simulated", number(verdict["sim_time"]), "s"),
        ("wall time", number(verdict["wall_time"]), "s"),
    ]
    if verdict.get("real_time_factor"):
        facts.append(("real time", f"{verdict['real_time_factor']:.1f}", "×"))
    tiles = "".join(f"<div><dt>{a}</dt><dd>{b}<small> {c}</small></dd></div>" for a, b, c in facts)
    return (
        f'<header class="{kind}"><div><h1>{escape(str(verdict["scenario"]))}'
        f"<small> seed {escape(str(verdict['seed']))}</small>"
        f'<span class="pill">{word}</span></h1>{reason}{drives}</div><dl>{tiles}</dl></header>\n'
    )


def criteria(run: Run) -> str | None:
    """Returns the table of a run's criteria, None without any."""
    return criteria_table(run.verdict.get("criteria") or {})


def criteria_table(entries: Mapping[str, Mapping[str, Any]]) -> str | None:
    """Returns the table of criteria, each with a bar of how much of its limit is used."""
    if not entries:
        return None
    rows = "".join(_criterion(name, entry) for name, entry in entries.items())
    return f'<table class="criteria"><tbody>{rows}</tbody></table>'


def _criterion(name: str, entry: Mapping[str, Any]) -> str:
    value, limit = entry["value"], entry["limit"]
    upper = entry.get("bound", "max") == "max"
    used = 1.0 if value is None else _share(value, limit) if upper else _share(limit, value)
    kind, word = ("good", "pass") if entry["passed"] else ("bad", "fail")
    shown = "none" if value is None else number(value)
    return (
        f'<tr class="{kind}"><th>{escape(name)}</th><td class="number">{shown}</td>'
        f'<td class="number limit">{"≤" if upper else "≥"} {number(limit)}'
        f" <small>{window_text(entry)}</small></td>"
        f'<td class="bar"><i style="width:{100 * used:.0f}%"></i></td><td class="word">{word}</td></tr>'
    )


def _share(part: float, whole: float) -> float:
    return min(max(part / whole, 0.0), 1.0) if whole else 1.0


def disturbances(run: Run) -> str:
    """Returns the key to the letters over the figures."""
    if not run.spans:
        return ""
    chips = "".join(
        f"<li><b>{span.letter}</b> {escape(span.about)} <small>{when(span)}</small></li>"
        for span in run.spans
    )
    return f'<ul class="chips">{chips}</ul>\n'


def when(span: Span) -> str:
    """Returns when a disturbance acts, in words."""
    if span.end < inf:
        return f"{span.start:g}–{span.end:g} s"
    always = "in its area" if span.area else "all the time"
    return f"from {span.start:g} s on" if span.start > 0 else always


def shots(run: Run) -> str | None:
    """Returns the camera frames with a line at every detection; None without a camera."""
    if not run.shots:
        return None
    return f'<div class="shots">{"".join(_shot(shot) for shot in run.shots)}</div>'


def _shot(shot: Shot) -> str:
    width, height = (int.from_bytes(shot.png[k : k + 4], "big") for k in (16, 20))  # of the PNG's header
    lines = "".join(
        f'<line x1="{x + 0.5:.1f}" x2="{x + 0.5:.1f}" y1="0" y2="{height}"/>'
        + ("" if beacon is None else f'<text x="{x + 4:.1f}" y="12">{beacon}</text>')
        for x, beacon in zip(shot.pixels, shot.beacons, strict=True)
    )
    picture = f'<image width="{width}" height="{height}" href="data:image/png;base64,{base64(shot.png)}"/>'
    return (
        f'<figure><svg role="img" aria-label="camera at {shot.t:.1f} s" viewBox="0 0 {width} {height}">'
        f"{picture}{lines}</svg><figcaption>t = {shot.t:.1f} s</figcaption></figure>"
    )


def base64(data: bytes) -> str:
    """Returns data as a page can hold them."""
    return b64encode(data).decode()


def cost(run: Run) -> str | None:
    """Returns where the wall time went, as one bar and a table with a column for what other processes did."""
    parts = {name: value for name, value in (run.verdict.get("cost") or {}).items() if value}
    beside: Mapping[str, float] = run.verdict.get("cost_beside") or {}
    wall = run.verdict.get("wall_time") or 0.0
    if not parts or not wall:
        return None
    parts = {name: max(value - beside.get(name, 0.0), 0.0) for name, value in parts.items()}
    parts["the rest"] = max(wall - sum(parts.values()), 0.0)
    bar = rows = ""
    for (name, value), colour in zip(parts.items(), _PARTS, strict=False):
        share = 100 * value / wall
        apart = f"{number(beside[name])} s beside" if beside.get(name) else ""
        bar += f'<i style="width:{share:.2f}%;background:{colour}" title="{escape(name)}"></i>'
        rows += (
            f'<tr><th><i class="dot" style="background:{colour}"></i>{escape(name)}</th>'
            f'<td class="number">{number(value)} s</td><td class="number">{share:.1f} %</td>'
            f'<td class="number">{apart}</td></tr>'
        )
    return f'<div class="stack">{bar}</div><table><tbody>{rows}</tbody></table>'


def metrics(run: Run) -> str | None:
    """Returns every metric with its unit and its meaning."""
    found = run.verdict.get("metrics") or {}
    if not found:
        return None
    rows = "".join(_metric(name, value) for name, value in found.items())
    return f'<div class="scroll"><table class="metrics"><tbody>{rows}</tbody></table></div>'


def _metric(name: str, value: float | None) -> str:
    metric = METRICS.get(name) or METRICS.get(name.rpartition(".")[2])
    about, unit = (metric.about, metric.unit) if metric else ("", "")
    shown = "none" if value is None else f"{number(value)} {unit}"
    cells = f'<td class="number">{shown}</td><td class="about">{escape(about)}</td>'
    return f"<tr><th>{escape(name)}</th>{cells}</tr>"


def counts(run: Run) -> str | None:
    """Returns what estimator, controller and sensors have counted, and what that means."""
    rows = "".join(
        f'<tr><th>{escape(part)}</th><td>{escape(name)}</td><td class="number">'
        f"{'none' if value is None else number(value)}</td>"
        f'<td class="about">{escape(ABOUT.get(name, ""))}</td></tr>'
        for part, found in (run.verdict.get("counts") or {}).items()
        for name, value in found.items()
    )
    return f'<table class="metrics"><tbody>{rows}</tbody></table>' if rows else None


def detectors(run: Run) -> str | None:
    """Returns what foreign detectors did wrong, None where they did nothing wrong."""
    lines = [
        f"{camera}: {line}"
        for camera, found in (run.verdict.get("detectors") or {}).items()
        for line in found
    ]
    return f"<pre>{escape(chr(10).join(lines))}</pre>" if lines else None


def files(run: Run) -> str:
    """Returns links to what else is in the folder, and the fingerprints of the run."""
    names = [name for name in (MCAP, CAN, SIGNALS, VERDICT, ATTRIBUTION) if (run.folder / name).exists()]
    names += [f"{DETECTORS}/{log.name}" for log in sorted((run.folder / DETECTORS).glob("*.log"))]
    links = " · ".join(f'<a href="{quote(name)}">{escape(name)}</a>' for name in names)
    prints = "<br>".join(
        f"{key} <code>{escape(str(run.verdict.get(key, '')))}</code>" for key in ("hash", "signals_hash")
    )
    if run.verdict.get("reproducible") is False:
        prints += "<br>not reproducible: the wall clock had a say in this run"
    return f'<p class="files">{links}</p><p class="files">{prints}</p>'


def document(run: Run, body: str) -> str:
    """Returns the whole page of a run."""
    return whole(f"{run.verdict['scenario']}, seed {run.verdict['seed']}", body)


def whole(title: str, body: str) -> str:
    """Returns a whole page."""
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{escape(title)} · hilbed</title><style>{_variables()}{_sheet()}</style></head>\n"
        f"<body><main>{body}</main></body></html>\n"
    )


def _sheet() -> str:
    from importlib.resources import files as resources

    return resources("hilbed.report").joinpath("page.css").read_text(encoding="utf-8")


def _variables() -> str:
    def block(index: int) -> str:
        return "".join(f"--{name}:{theme[index]};" for name, theme in (COLOURS | _SURFACES).items())

    dark = f"@media (prefers-color-scheme:dark){{:root{{{block(1)}}}}}"
    return f":root{{color-scheme:light dark;{block(0)}}}{dark}"


_SURFACES = {
    "page": Theme("#f3f5f8", "#101317"),
    "card": Theme("#ffffff", "#191d23"),
    "soft": Theme("#eef1f5", "#232932"),
}


def number(value: float) -> str:
    """Returns a number with four digits that mean something."""
    return f"{value:.4g}"
