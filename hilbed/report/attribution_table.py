"""Where the error of the estimate comes from, as a table; the numbers go to attribution.json as well."""

from __future__ import annotations

import json
from html import escape
from math import isfinite

from hilbed.attribution import Attribution, Error, as_dict, attribute
from hilbed.record.folder import ATTRIBUTION, SCENARIO, write_whole
from hilbed.report.run import Run
from hilbed.scenario.load import load
from hilbed.types import HilbedError

NOTE = (
    "The estimator was run again over what this run has recorded, with one source replaced by the truth "
    "(without), and with all others replaced (alone). The sources act on one another, so they do not add up; "
    "what was as the truth is not listed."
)


_HEADS = "".join(f'<th class="number">{head}</th>' for head in ("without, mm", "mrad", "alone, mm", "mrad"))


def table(run: Run) -> str | None:
    """Returns the table and writes attribution.json; None where no truth is known, or the run is too old."""
    try:
        found = attribute(load(str(run.folder / SCENARIO)), run.signals)
    except HilbedError:
        return None
    if found is None or not found.shares:
        return None
    write_whole(run.folder / ATTRIBUTION, (json.dumps(as_dict(found), indent=2) + "\n").encode())
    most = max((s.alone.position for s in found.shares if isfinite(s.alone.position)), default=0.0)
    rows = "".join(
        _row(share.source, share.without, share.alone, most)
        for share in sorted(found.shares, key=lambda share: -_size(share.alone))
    )
    return (
        f'<table class="criteria"><thead><tr><th>source</th>{_HEADS}<th></th></tr></thead>'
        f"<tbody>{rows}</tbody></table>{_foot(found)}"
    )


def _row(source: str, without: Error, alone: Error, most: float) -> str:
    cells = "".join(f'<td class="number">{_milli(x)}</td>' for x in (*without, *alone))
    width = 100 * alone.position / most if most and isfinite(alone.position) else 0
    bar = f'<td class="bar"><i style="width:{width:.0f}%"></i></td>'
    return f'<tr class="good"><th>{escape(source)}</th>{cells}{bar}</tr>'


def _foot(found: Attribution) -> str:
    same = "gives the same" if found.rerun == found.recorded else f"gives {_both(found.rerun)}"
    return (
        f'<p class="note">This run: {_both(found.recorded)} rms; its rerun with nothing replaced {same}. '
        f"With everything replaced {_both(found.nothing)} are left: what the estimator does by itself.</p>"
    )


def _both(error: Error) -> str:
    return f"{_milli(error.position)} mm, {_milli(error.yaw)} mrad"


def _milli(value: float) -> str:
    return f"{1e3 * value:.3g}" if isfinite(value) else "lost"


def _size(error: Error) -> float:
    return error.position if isfinite(error.position) else float("inf")
