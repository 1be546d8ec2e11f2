"""The page of a paper: its figures in its order, ideal and on the bench side by side."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from html import escape

from hilbed.paper import tables
from hilbed.paper.catalogue import Paper, Section
from hilbed.paper.runs import End
from hilbed.report import page
from hilbed.report.run import Run
from hilbed.types import Pose

Figure = Callable[[Run], str | None]


def figures() -> dict[str, Figure]:
    """Returns what can be drawn of a run, by its word in a paper's file."""
    from hilbed.report import drive_figures, pose_figures, sensor_figures, state_figures

    return {
        "path": pose_figures.path,
        "states": state_figures.states,
        "errors": pose_figures.errors,
        "tracking": pose_figures.tracking,
        "commands": state_figures.commands,
        "landmark": state_figures.landmark,
        "observability": state_figures.observability,
        "speeds": drive_figures.speeds,
        "efforts": drive_figures.efforts,
        "nis": sensor_figures.nis,
    }


def write(name: str, paper: Paper, runs: Mapping[str, Run], ends: Mapping[End, Pose]) -> str:
    """Returns the whole page."""
    from hilbed.report import style

    with style.drawing():
        sections = "".join(_section(section, runs, ends) for section in paper.sections)
    failed = [scenario for scenario, run in runs.items() if not run.verdict["passed"]]
    word, kind = (f"{len(failed)} of {len(runs)} failed", "bad") if failed else ("all passed", "good")
    reason = f'<p class="reason">{escape(", ".join(failed))}</p>' if failed else ""
    head = (
        f'<header class="{kind}"><div><h1>{escape(paper.title)}'
        f'<span class="pill">{word}</span></h1>{reason}</div></header>\n'
    )
    lists = _list("Misprints, mended", paper.mended) + _list("Free choices", paper.free)
    return page.whole(name, f'{head}{sections}<div class="grid">{lists}</div>')


def _section(section: Section, runs: Mapping[str, Run], ends: Mapping[End, Pose]) -> str:
    cards = page.card("Printed and ours", tables.claims(section.claims, runs), wide=True)
    if section.table is not None:
        poses = [pose for end, pose in ends.items() if _belongs(end, section)]
        cards += page.card("Final poses", tables.statistics(section.table, poses), wide=True)
    for scenario in section.scenarios:
        for name in (scenario, f"{scenario}-bench"):
            if name in runs:
                cards += _run(name, runs[name], section)
    text = f'<p class="note">{escape(section.text)}</p>' if section.text else ""
    return f'<h2>{escape(section.title)}</h2>{text}<div class="grid">{cards}</div>\n'


def _belongs(end: End, section: Section) -> bool:
    table = section.table
    if table is None:
        return False
    first, last = table.seeds
    return end.scenario in table.scenarios and first <= end.seed <= last


def _run(name: str, run: Run, section: Section) -> str:
    known = figures()
    drawn = "".join(known[word](run) or "" for word in section.draw)
    link = f'<a href="{escape(run.folder.name)}/report.html">whole report</a>'
    return page.card(name, drawn + (page.criteria(run) or ""), link)


def _list(title: str, entries: list[str]) -> str:
    items = "".join(f"<li>{escape(entry)}</li>" for entry in entries)
    return page.card(title, f"<ul>{items}</ul>" if entries else None)
