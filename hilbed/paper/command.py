"""What `hilbed paper` does: runs, page, table for the terminal."""

from __future__ import annotations

import os
from pathlib import Path

from hilbed.paper.catalogue import Paper, read
from hilbed.paper.page import write
from hilbed.paper.runs import End, Experiment, perform_all
from hilbed.record.folder import write_whole
from hilbed.report.run import read_run
from hilbed.scenario import bundled
from hilbed.types import ScenarioError

PAGE = "paper.html"


def paper(name: str, out: Path | None, jobs: int | None, ideal: bool, force: bool) -> int:
    """Runs all experiments of a paper, writes its page and returns 0 where every criterion is met, else 1.

    ideal: without the twins on the bench. Raises ScenarioError before the first run.
    """
    if jobs is not None and jobs < 1:
        raise ScenarioError(f"--jobs {jobs}: at least one process has to run")
    content, folder = read(name), out or Path("runs") / f"paper-{name}"
    if folder.exists() and not (folder / PAGE).exists() and any(folder.iterdir()):
        raise ScenarioError(f"{folder} holds something else than a paper; give another folder with --out")
    if (folder / PAGE).exists() and not force:
        raise ScenarioError(f"{folder} exists; --force replaces the page and the runs in it")
    experiments = [Experiment(one, folder / one.rpartition("/")[2]) for one in _scenarios(content, ideal)]
    statuses, ends = perform_all(experiments, _ends(content), jobs or os.cpu_count() or 1)
    runs = {one.scenario: read_run(one.folder) for one in experiments}
    write_whole(folder / PAGE, write(name, content, runs, ends).encode())
    for scenario, status in statuses.items():
        print(f"{scenario}: {'passed' if status == 0 else 'FAILED ' + str(runs[scenario].verdict['reason'])}")
    print(f"page: {folder / PAGE}")
    return 0 if not any(statuses.values()) else 1


def _scenarios(content: Paper, ideal: bool) -> list[str]:
    """Returns the paper's scenarios, each followed by its twin, where there is one."""
    known = set(bundled.names())
    found = []
    for name in content.scenarios():
        found += [name] if ideal else [one for one in (name, f"{name}-bench") if one in known]
    return found


def _ends(content: Paper) -> list[End]:
    tables = [section.table for section in content.sections if section.table is not None]
    return [
        End(scenario, seed)
        for table in tables
        for scenario in table.scenarios
        for seed in range(table.seeds[0], table.seeds[1] + 1)
    ]
