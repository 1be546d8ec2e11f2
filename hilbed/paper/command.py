"""What `hilbed paper` does: runs, page, table for the terminal."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from hilbed.console import progress
from hilbed.paper.catalogue import Paper, read
from hilbed.paper.kept import KeptEnds
from hilbed.paper.page import Content, write
from hilbed.paper.plan import End, Experiment, ends, experiments
from hilbed.paper.runs import Results, perform_all
from hilbed.record.folder import write_whole
from hilbed.report.run import ReportError, read_run
from hilbed.runner import BROKEN, FAILED, INTERRUPTED, PASSED, processors
from hilbed.types import ScenarioError

PAGE = "paper.html"


class Options(NamedTuple):
    """out: folder of page and runs; jobs: processes at a time; ideal: without the twins on the bench.

    seeds: so many of each scenario at most behind the tables of final poses; force: all anew.
    """

    out: Path | None = None
    jobs: int | None = None
    ideal: bool = False
    seeds: int | None = None
    force: bool = False


def paper(name: str, options: Options) -> int:
    """Runs all experiments of a paper, writes its page and returns the exit status.

    0 where every criterion is met; 1 where not; 2 where interrupted, 3 where a run has broken off: then the
    page shows what there is. Runs that the folder holds already are taken as they are, unless forced.
    Raises ScenarioError before the first run.
    """
    return publish(name, read(name), options)


def publish(name: str, content: Paper, options: Options) -> int:
    """Does it for a paper that has been read."""
    for option, value in (("--jobs", options.jobs), ("--seeds", options.seeds)):
        if value is not None and value < 1:
            raise ScenarioError(f"{option} {value}: at least 1 is needed")
    folder = options.out or Path("runs") / f"paper-{name}"
    planned = experiments(content, folder, options.ideal)
    asked = ends(content, options.seeds)
    _take(folder)
    draft = Content(name, content, {one.name: one.folder.name for one in planned}, Results(), {})
    if not (folder / PAGE).exists():
        write_whole(folder / PAGE, write(draft).encode())  # says whose folder it is
    results = _results(planned, asked, folder, options)
    progress("writing the page")
    _write(draft._replace(results=results), planned, folder)
    _tell(results, planned, folder)
    return _status(results)


def _take(folder: Path) -> None:
    """Makes the folder; raises ScenarioError where it cannot, or where it holds something else."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if not (folder / PAGE).exists() and any(folder.iterdir()):
            raise ScenarioError(f"{folder} holds something else than a paper; give another folder with --out")
        probe = folder / ".writable"
        probe.touch()
        probe.unlink()
    except OSError as error:
        raise ScenarioError(f"{folder}: {error.strerror}; give another folder with --out") from error


def _results(planned: Sequence[Experiment], asked: Sequence[End], folder: Path, options: Options) -> Results:
    """Runs what is not there already."""
    kept = KeptEnds(folder, sorted({end.scenario for end in asked}))
    known = {} if options.force else kept.read()
    todo = [end for end in asked if end not in known]
    results = perform_all(planned, todo, options.jobs or processors(), options.force)
    results.ends = {**known, **results.ends}
    kept.write(results.ends)
    results.ends = {end: results.ends[end] for end in asked if end in results.ends}
    return results


def _write(content: Content, planned: Sequence[Experiment], folder: Path) -> None:
    runs = {}
    for one in planned:
        if one.name in content.results.runs:
            try:
                runs[one.name] = read_run(one.folder)
            except ReportError as error:
                content.results.lost.append(f"{one.name}: {error}")
    write_whole(folder / PAGE, write(content._replace(runs=runs)).encode())


def _tell(results: Results, planned: Sequence[Experiment], folder: Path) -> None:
    progress("")
    for one in planned:
        done = results.runs.get(one.name)
        if done is None:
            print(f"{one.name}: not run")
            continue
        word = "passed" if done.status == PASSED else f"FAILED {done.reason}"
        print(f"{one.name}: {word}{' (kept)' if done.kept else ''}")
        if done.trace:
            print(f"{done.trace}This is a mistake in hilbed, not in the scenario.", file=sys.stderr)
    for line in results.lost:
        print(line, file=sys.stderr)
    if results.interrupted:
        print("interrupted; the same command goes on where it was", file=sys.stderr)
    if any(done.kept for done in results.runs.values()):
        print("kept: as an earlier run has left it; --force runs it anew")
    print(f"page: {folder / PAGE}")


def _status(results: Results) -> int:
    if results.interrupted:
        return INTERRUPTED
    if results.lost:
        return BROKEN
    statuses = {done.status for done in results.runs.values()}
    if statuses - {PASSED, FAILED}:
        return BROKEN
    return FAILED if FAILED in statuses else PASSED
