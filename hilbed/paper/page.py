"""The page of a paper: its figures in its order, ideal and on the bench side by side."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from html import escape
from typing import NamedTuple

from hilbed.criteria import Missing
from hilbed.paper import tables, upsets
from hilbed.paper.catalogue import TWIN, Figure, Paper, Table
from hilbed.paper.drawings import Runs, drawers
from hilbed.paper.plan import variants
from hilbed.paper.runs import Results
from hilbed.report import page
from hilbed.report.run import Run

IDEAL, BENCH = "as in the paper", "on the bench"


class Content(NamedTuple):
    """What the page is made from: the paper, the folders of the planned runs, what has come out so far."""

    name: str
    paper: Paper
    folders: Mapping[str, str]
    results: Results
    runs: Mapping[str, Run]


def write(content: Content) -> str:
    """Returns the whole page, of what there is."""
    from hilbed.report import style

    paper, results = content.paper, content.results
    with style.drawing():
        sections = "".join(_section(k, content) for k in range(len(paper.sections)))
    lists = _list("Misprints, mended", paper.mended) + _list("Free choices", paper.free)
    overview = page.card("Experiments", tables.overview(content.folders, results.runs), wide=True)
    body = f'<div class="grid">{overview}{lists}</div>{sections}'
    return page.whole(content.name, _head(content) + body)


def _head(content: Content) -> str:
    planned, done = content.folders, content.results.runs
    failed = {name: one.reason for name, one in done.items() if one.status}
    left = len(planned) - len(done)
    words = [f"{len(failed)} of {len(done)} failed"] * bool(failed) + [f"{left} not run"] * bool(left)
    kind = "bad" if words or content.results.lost else "good"
    reasons = [f"{name}: {reason or 'a criterion failed'}" for name, reason in failed.items()]
    told = "".join(f'<p class="reason">{escape(line)}</p>' for line in [*reasons, *content.results.lost])
    word = ", ".join(words) or f"all {len(done)} passed"
    return (
        f'<header class="{kind}"><div><h1>{escape(content.paper.title)}'
        f'<span class="pill">{word}</span></h1>{told}</div></header>\n'
    )


def _section(k: int, content: Content) -> str:
    section, before = content.paper.sections[k], content.paper.sections[:k]
    judged = {name for earlier in before for name in earlier.names()}
    names = [name for name in section.names() if name not in judged]
    cards = page.card("Printed and ours", tables.claims(section.claims, content.runs), wide=True)
    cards += page.card("Sensors and disturbances", upsets.acting(names, content.runs), wide=True)
    if section.table is not None:
        cards += page.card("Final poses", _statistics(section.table, content), wide=True)
    cards += "".join(_figure(figure, content.runs) for figure in section.figures)
    cards += page.card("Criteria", tables.criteria(names, content.runs), wide=True)
    text = f'<p class="note">{escape(section.text)}</p>' if section.text else ""
    return f'<h2 class="section">{escape(section.title)}</h2>{text}<div class="grid">{cards}</div>\n'


def _statistics(table: Table, content: Content) -> str:
    first, last = table.seeds
    ends = content.results.ends.items()
    poses = [pose for end, pose in ends if end.scenario in table.scenarios and first <= end.seed <= last]
    return tables.statistics(table, poses) or "not run"


def _figure(figure: Figure, runs: Mapping[str, Run]) -> str:
    """Returns the card of a figure: as in the paper and, beside it, on the bench."""
    sides = [_drawn(figure, side) for side in _sides(figure, runs)]
    shown = [side for side in sides if side]
    body = f'<div class="pair">{"".join(shown)}</div>' if len(shown) > 1 else "".join(shown)
    caption = figure.caption
    title = f"{figure.name}: {caption}" if figure.name else caption[:1].upper() + caption[1:]
    return page.card(title, body or '<p class="note">not run</p>', wide=len(shown) > 1)


def _sides(figure: Figure, runs: Mapping[str, Run]) -> tuple[Runs, Runs]:
    """Returns the runs of a figure by their names in a legend, and their twins."""
    names = dict(zip(_short(figure.scenarios), figure.scenarios, strict=True))
    if figure.vary is not None:
        varied = {f"{value:g}": name for name, value in variants(figure)}
        return _known(varied, runs), {}
    twins = {short: name + TWIN for short, name in names.items() if figure.bench}
    return _known(names, runs), _known(twins, runs)


def _known(names: Mapping[str, str], runs: Mapping[str, Run]) -> Runs:
    return {short: runs[name] for short, name in names.items() if name in runs}


def _short(names: list[str]) -> list[str]:
    """Returns the names without the paper's and, of many, without the first word that they share."""
    short = [tables.short(name) for name in names]
    shared = {name.partition("-")[0] for name in short}
    return [name.partition("-")[2] for name in short] if len(names) > 3 and len(shared) == 1 else short


def _drawn(figure: Figure, runs: Runs) -> str:
    """Returns one side of a figure with its label, nothing where there is nothing to draw."""
    if not runs:
        return ""
    label = IDEAL if _ideal(runs.values()) else BENCH
    try:
        drawing = drawers()[figure.draw](runs, figure)
    except (Missing, ArithmeticError, LookupError, TypeError, ValueError) as error:
        drawing = f'<p class="note">cannot be drawn: {escape(str(error))}</p>'  # a run that broke off
    return f'<div><p class="note">{label}</p>{drawing}</div>' if drawing else ""


def _ideal(runs: Iterable[Run]) -> bool:
    return all("kind: kinematic" in run.scenario for run in runs)


def _list(title: str, entries: list[str]) -> str:
    items = "".join(f"<li>{escape(entry)}</li>" for entry in entries)
    return page.card(title, f'<ul class="plain">{items}</ul>' if entries else None)
