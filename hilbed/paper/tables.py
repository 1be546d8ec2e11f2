"""The paper's numbers beside ours."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape

import numpy as np

from hilbed.angles import wrap
from hilbed.paper.catalogue import Claim, Table
from hilbed.report.run import Run
from hilbed.types import Pose

NAMES = ("x, m", "y, m", "yaw, rad")


def rows(head: Sequence[str], body: Sequence[Sequence[str]]) -> str:
    """Returns a table; numbers stand in all columns but the first."""
    top = "".join(f'<th class="number">{escape(cell)}</th>' for cell in head[1:])
    lines = [f"<tr><th>{escape(head[0])}</th>{top}</tr>"]
    for name, *cells in body:
        numbers = "".join(f'<td class="number">{escape(cell)}</td>' for cell in cells)
        lines.append(f"<tr><th>{escape(name)}</th>{numbers}</tr>")
    return f"<table><tbody>{''.join(lines)}</tbody></table>"


def claims(asked: Sequence[Claim], runs: Mapping[str, Run]) -> str | None:
    """Returns what the paper says beside what came out, and on the bench where there is a twin."""
    if not asked:
        return None
    body = [
        (claim.what, claim.printed, value(claim, runs, ""), value(claim, runs, "-bench")) for claim in asked
    ]
    return rows(("", "printed", "ours", "bench"), body)


def value(claim: Claim, runs: Mapping[str, Run], suffix: str) -> str:
    """Returns our number of a claim, or of its twin; a dash where there is none."""
    run = runs.get(claim.scenario + suffix)
    if run is None:
        return "–"
    if claim.ours == "final":
        return ", ".join(f"{number:.3f}" for number in run.signals["truth"][-1])
    if claim.ours.startswith("cost/"):
        spent = run.verdict["cost"][claim.ours.removeprefix("cost/")]
        return f"{1e3 * spent / len(run.signals['t']):.3f}"
    number = run.verdict["metrics"].get(claim.ours)
    return "–" if number is None else f"{number:.4g}"


def statistics(table: Table, poses: Sequence[Pose]) -> str:
    """Returns mean and standard deviation of final poses beside the printed ones."""
    ends = np.array(poses)
    ends[:, 2] = [table.mean[2] + wrap(yaw - table.mean[2]) for yaw in ends[:, 2].tolist()]
    mean, std = ends.mean(axis=0), ends.std(axis=0, ddof=1)
    body = [
        (name, *(f"{number:.4f}" for number in (table.mean[k], mean[k], table.std[k], std[k])))
        for k, name in enumerate(NAMES)
    ]
    head = (f"{len(poses)} runs", "mean, printed", "mean, ours", "std, printed", "std, ours")
    return rows(head, body)
