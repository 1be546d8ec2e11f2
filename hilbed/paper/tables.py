"""The paper's numbers beside ours, and the criteria of ideal runs beside those of their twins."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

import numpy as np

from hilbed.angles import wrap
from hilbed.criteria import window_text
from hilbed.paper.catalogue import TWIN, Claim, Table
from hilbed.paper.runs import Done
from hilbed.report.run import Run
from hilbed.types import Pose

NAMES = ("x, m", "y, m", "yaw, rad")
NONE = "–"


def short(name: str) -> str:
    """Returns the name of a scenario without that of its paper."""
    return name.rpartition("/")[2]


def rows(head: Sequence[str], body: Sequence[Sequence[str]]) -> str:
    """Returns a table; numbers stand in all columns but the first."""
    top = "".join(f'<th class="number">{escape(cell)}</th>' for cell in head[1:])
    lines = [f"<tr><th>{escape(head[0])}</th>{top}</tr>"]
    for name, *cells in body:
        numbers = "".join(f'<td class="number">{escape(cell)}</td>' for cell in cells)
        lines.append(f"<tr><th>{escape(name)}</th>{numbers}</tr>")
    return f'<div class="across"><table><tbody>{"".join(lines)}</tbody></table></div>'


def claims(asked: Sequence[Claim], runs: Mapping[str, Run]) -> str | None:
    """Returns what the paper says beside what came out, and on the bench where there is a twin.

    A column of closed forms and one of twins are there where any claim has one.
    """
    if not asked:
        return None
    laws = any(claim.law for claim in asked)
    twins = any(claim.scenario + TWIN in runs for claim in asked)
    head = ["", "printed", *["closed form"] * laws, "ours", *["bench"] * twins]
    body = [
        [
            claim.what,
            claim.printed,
            *[claim.law or NONE] * laws,
            value(claim, runs, ""),
            *[value(claim, runs, TWIN)] * twins,
        ]
        for claim in asked
    ]
    return rows(head, body)


def value(claim: Claim, runs: Mapping[str, Run], suffix: str) -> str:
    """Returns our number of a claim, or of its twin; a dash where there is none."""
    run = runs.get(claim.scenario + suffix)
    if run is None or not len(run.signals["t"]):
        return NONE
    if claim.ours == "final":
        return ", ".join(f"{number:.3f}" for number in run.signals["truth"][-1])
    if claim.ours.startswith("cost/"):
        spent = run.verdict["cost"][claim.ours.removeprefix("cost/")]
        return f"{1e3 * spent / len(run.signals['t']):.3f}"
    number = run.verdict["metrics"].get(claim.ours)
    return NONE if number is None else f"{number:.4g}"


def criteria(names: Sequence[str], runs: Mapping[str, Run]) -> str | None:
    """Returns every criterion of these scenarios, ideal beside bench; None where none has been run."""
    suffixes = ["", *[TWIN] * any(name + TWIN in runs for name in names)]
    body = "".join(_scenario(name, suffixes, runs) for name in names)
    if not body:
        return None
    words = ["ours", "limit", "bench", "limit"][: 2 * len(suffixes)]
    head = "".join(f'<th class="number">{word}</th>' for word in words)
    return f'<div class="across"><table><tbody><tr><th></th>{head}</tr>{body}</tbody></table></div>'


def _scenario(name: str, suffixes: Sequence[str], runs: Mapping[str, Run]) -> str:
    sides = [_criteria_of(runs.get(name + suffix)) for suffix in suffixes]
    lines = "".join(
        f"<tr><td>{escape(criterion)}</td>{''.join(_cells(side.get(criterion)) for side in sides)}</tr>"
        for criterion in dict.fromkeys(criterion for side in sides for criterion in side)
    )
    return f'<tr><th colspan="{1 + 2 * len(sides)}">{escape(short(name))}</th></tr>{lines}' if lines else ""


def _criteria_of(run: Run | None) -> Mapping[str, Any]:
    return {} if run is None else run.verdict["criteria"]


def _cells(entry: Mapping[str, Any] | None) -> str:
    if entry is None:
        return '<td></td><td class="number limit"></td>'
    shown = "none" if entry["value"] is None else f"{entry['value']:.4g}"
    sign = "≤" if entry.get("bound", "max") == "max" else "≥"
    kind = "met" if entry["passed"] else "unmet"
    words = f"{sign} {entry['limit']:.4g} {window_text(entry)}".rstrip()
    limit = f'<td class="number limit">{words}</td>'
    return f'<td class="number {kind}">{shown}</td>{limit}'


def overview(folders: Mapping[str, str], done: Mapping[str, Done]) -> str:
    """Returns whether each scenario has passed, ideal and on the bench, with links to the reports.

    folders: of every run that was planned, below that of the page. Runs in which a value varies are counted.
    """
    names = list(dict.fromkeys(name.partition("@")[0].removesuffix(TWIN) for name in folders))
    suffixes = ["", *[TWIN] * any(name.endswith(TWIN) for name in folders)]
    varied = {name: [one for one in folders if one.startswith(f"{name}@")] for name in names}
    words = ["as in the paper", "bench twin"][: len(suffixes)] + ["values varied"] * any(varied.values())
    head = "<tr><th></th>" + "".join(f'<th class="number">{word}</th>' for word in words) + "</tr>"
    body = ""
    for name in names:
        cells = "".join(_mark(name + suffix, folders, done) for suffix in suffixes)
        cells += _counted(varied[name], done) if any(varied.values()) else ""
        body += f"<tr><th>{escape(short(name))}</th>{cells}</tr>"
    return f'<div class="across"><table><tbody>{head}{body}</tbody></table></div>'


def _counted(names: Sequence[str], done: Mapping[str, Done]) -> str:
    if not names:
        return "<td></td>"
    passed = sum(name in done and done[name].status == 0 for name in names)
    kind = "met" if passed == len(names) else "unmet"
    return f'<td class="number {kind}">{passed} of {len(names)} passed</td>'


def _mark(name: str, folders: Mapping[str, str], done: Mapping[str, Done]) -> str:
    if name not in folders:
        return "<td></td>"
    if name not in done:
        return '<td class="number unmet">not run</td>'
    word, kind = ("passed", "met") if done[name].status == 0 else ("failed", "unmet")
    link = f'<a href="{escape(folders[name])}/report.html">report</a>'
    return f'<td class="number"><span class="{kind}">{word}</span> · {link}</td>'


def statistics(table: Table, poses: Sequence[Pose]) -> str | None:
    """Returns mean and standard deviation of final poses beside the printed ones; None of less than two."""
    if len(poses) < 2:
        return None
    ends = np.array(poses)
    ends[:, 2] = [table.mean[2] + wrap(yaw - table.mean[2]) for yaw in ends[:, 2].tolist()]
    mean, std = ends.mean(axis=0), ends.std(axis=0, ddof=1)
    body = [
        (name, *(f"{number:.4f}" for number in (table.mean[k], mean[k], table.std[k], std[k])))
        for k, name in enumerate(NAMES)
    ]
    head = (f"{len(poses)} runs", "mean, printed", "mean, ours", "std, printed", "std, ours")
    return rows(head, body)
