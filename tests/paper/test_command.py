"""A small paper from its experiments to its page, and all that may go wrong on the way."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures.process import BrokenProcessPool
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hilbed import loop, runner
from hilbed.paper import runs
from hilbed.paper.command import Options, paper, publish
from hilbed.types import Cycle, Diverged, ScenarioError
from tests.bench import ran
from tests.paper.small import ONE, TWO, in_threads, published, small


class Cells(HTMLParser):
    """The rows of all tables, each by its first cell, and the text of the page."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.rows: list[list[str]] = []
        self.text = ""
        self._cell = False
        self.feed(page)

    def handle_starttag(self, tag: str, _: object) -> None:
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")
            self._cell = True

    def handle_endtag(self, tag: str) -> None:
        self._cell = self._cell and tag not in ("td", "th")

    def handle_data(self, data: str) -> None:
        self.text += data
        if self._cell:
            self.rows[-1][-1] += data

    def row(self, name: str) -> list[str]:
        return next(row[1:] for row in self.rows if row and row[0] == name)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Path, int, str]]:
    with pytest.MonkeyPatch.context() as patch:
        folder = tmp_path_factory.mktemp("paper") / "small"
        yield folder, *published(patch, folder, small())


def test_a_criterion_that_fails_is_told_and_the_rest_is_there(made: tuple[Path, int, str]) -> None:
    folder, status, page = made
    cells = Cells(page)
    assert status == 1, "a wheelbase of 1.5 m makes another circle"
    assert "1 of 4 failed" in cells.text
    assert cells.row("test1-type1") == ["passed · report", "1 of 2 passed"]
    assert cells.row("test1-type2") == ["passed · report", ""]
    assert (folder / "test1-type1" / "report.html").exists()
    assert not (folder / "test1-type1-at-1.5" / "report.html").exists()


def test_the_papers_numbers_stand_beside_ours(made: tuple[Path, int, str]) -> None:
    folder, _, page = made
    cells = Cells(page)
    assert cells.row("radius") == ["–", "1.7320", f"{np.sqrt(3):.4g}"]
    turned = 10 * np.tan(np.pi / 6)
    final = np.sqrt(3) * np.sin(turned), np.sqrt(3) * (1 - np.cos(turned)), turned - 2 * np.pi
    assert cells.row("pose") == ["left", "–", ", ".join(f"{number:.3f}" for number in final)]
    verdict = json.loads((folder / "test1-type1" / "verdict.json").read_bytes())
    assert float(cells.row("time")[2]) == pytest.approx(1e3 * verdict["cost"]["estimator"] / 101, abs=6e-4)


def test_final_poses_are_those_of_the_runs_with_these_seeds(made: tuple[Path, int, str]) -> None:
    kept = json.loads((made[0] / "ends.json").read_bytes())[ONE]["poses"]
    assert kept["4"] == pytest.approx(ran(ONE, seed=4).signals["truth"][-1].tolist())
    cells = Cells(made[2])
    assert cells.row("3 runs") == ["mean, printed", "mean, ours", "std, printed", "std, ours"]
    assert cells.row("x, m") == ["-1.7000", "-1.6609", "0.1000", "0.0000"]


def test_the_page_shows_every_figure_and_needs_nothing_from_elsewhere(made: tuple[Path, int, str]) -> None:
    _, _, page = made
    labels = re.findall(r'aria-label="([^"]*)"', page)
    assert labels == ["paths", "tracking errors", "paths"]
    for word in ("Fig. 7: paths", "Errors", "a &lt; b", "<li>two</li>", "Both types."):
        assert word in page
    assert "http" not in re.sub(r'xmlns(:\w+)?="[^"]*"', "", page)


def test_criteria_stand_beside_their_limits(made: tuple[Path, int, str]) -> None:
    value, limit = Cells(made[2]).row("radius_least")
    assert float(value) >= float(limit.removeprefix("≥ "))


def test_what_is_there_is_taken_as_it_is_unless_forced(
    made: tuple[Path, int, str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    folder, _, page = made
    in_threads(monkeypatch)
    performed: list[object] = []

    def noted(*arguments: Any) -> Any:
        performed.append(arguments)
        return perform(*arguments)

    perform = runner.perform
    monkeypatch.setattr(runner, "perform", noted)
    assert publish("small", small(), Options(folder, ideal=True)) == 1
    assert not performed
    assert (folder / "paper.html").read_text() == page
    out = capsys.readouterr().out
    assert f"{ONE}: passed (kept)" in out
    (folder / "test1-type2" / "verdict.json").write_text("{}")
    assert publish("small", small(), Options(folder, ideal=True)) == 1
    assert len(performed) == 1, "the run that is broken is run anew, no other"
    publish("small", small(), Options(folder, ideal=True, force=True))
    assert len(performed) == 1 + 4


def test_a_run_that_breaks_off_leaves_a_page_of_what_there_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def until_2_s(*arguments: Any) -> Iterator[Cycle]:
        for cycle in loop_run(*arguments):
            if cycle.t > 2_000_000_000:
                raise Diverged("t = 2.100 s: the robot has left the world")
            yield cycle

    loop_run = loop.run
    monkeypatch.setattr(loop, "run", until_2_s)
    status, page = published(monkeypatch, tmp_path / "p", small())
    cells = Cells(page)
    assert status == 3
    assert "4 of 4 failed" in cells.text
    assert f"{ONE}: t = 2.100 s: the robot has left the world" in cells.text
    assert f"{ONE}, seed 3: t = 2.100 s" in cells.text
    assert re.findall(r'aria-label="([^"]*)"', page) == ["paths", "tracking errors", "paths"]
    assert "FAILED t = 2.100 s" in capsys.readouterr().out


@pytest.mark.parametrize("rows", [0, 1])
def test_a_run_that_has_hardly_begun_has_a_page(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, rows: int
) -> None:
    def nowhere(*arguments: Any) -> Iterator[Cycle]:
        for k, cycle in enumerate(loop_run(*arguments)):
            if k == rows:
                raise Diverged("at once")
            yield cycle

    loop_run = loop.run
    monkeypatch.setattr(loop, "run", nowhere)
    status, page = published(monkeypatch, tmp_path / "p", small())
    assert status == 3
    assert "at once" in Cells(page).text


def test_an_experiment_that_cannot_be_run_is_told_and_the_others_are(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    figure = {"caption": "f", "draw": "paths", "scenarios": [ONE]}
    wrong = figure | {"vary": {"path": "robot.wheelbase", "values": [-1.0]}}
    paper = small(sections=[{"title": "s", "figures": [figure, wrong]}])
    status, page = published(monkeypatch, tmp_path / "p", paper)
    cells = Cells(page)
    assert status == 3
    assert "1 not run" in cells.text
    assert f"{ONE}@-1: --set robot.wheelbase=-1.0" in cells.text
    assert cells.row("test1-type1") == ["passed · report", "0 of 1 passed"]


def test_an_interrupt_leaves_a_page_and_the_next_time_goes_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def after_two(futures: dict[Any, Any]) -> Iterator[Any]:
        for done, future in enumerate(futures):
            if done == 2:
                raise KeyboardInterrupt
            future.result()
            yield future

    with monkeypatch.context() as patch:
        patch.setattr(runs, "as_completed", after_two)
        status, page = published(patch, tmp_path / "p", small())
    assert status == 2
    assert "2 not run" in Cells(page).text
    assert Cells(page).row("test1-type2") == ["passed · report", ""]
    assert "goes on where it was" in capsys.readouterr().err
    status, page = published(monkeypatch, tmp_path / "p", small())
    assert "not run" not in Cells(page).text
    assert f"{TWO}: passed (kept)" in capsys.readouterr().out


def _alive(group: int) -> bool:
    """Tells whether a process of the session is left."""
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return False
    return True


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_all_processes_with_status_2(tmp_path: Path, number: signal.Signals) -> None:
    folder = tmp_path / "p"
    command = [sys.executable, "-m", "hilbed", "paper", "pliego2023", "--ideal", "--jobs", "1", "--out"]
    process = subprocess.Popen([*command, str(folder)], start_new_session=True, stdout=subprocess.DEVNULL)
    try:
        while not (folder / "observer-so2" / "verdict.json").exists():
            assert process.poll() is None
            time.sleep(0.05)
        os.killpg(process.pid, number) if number == signal.SIGINT else process.send_signal(number)
        assert process.wait(60) == 2
        while _alive(process.pid):
            time.sleep(0.05)
    finally:
        process.kill()
    assert "not run" in (folder / "paper.html").read_text()


def test_a_process_that_is_killed_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: Any) -> None:
        raise BrokenProcessPool

    monkeypatch.setattr(runs, "run", broken)
    status, page = published(monkeypatch, tmp_path / "p", small())
    assert status == 3
    assert page.count(runs.KILLED) == 1


def test_a_folder_that_cannot_be_used_is_refused_before_the_first_run(tmp_path: Path) -> None:
    (tmp_path / "letter.txt").write_text("dear")
    for place, word in (
        (tmp_path, "something else than a paper"),
        (tmp_path / "letter.txt", "give another folder"),
        (tmp_path / "letter.txt" / "below", "give another folder"),
        (Path("/proc/nowhere"), "give another folder"),
    ):
        with pytest.raises(ScenarioError, match=word):
            paper("pliego2023", Options(place, ideal=True))
    assert (tmp_path / "letter.txt").read_text() == "dear"
    assert len(list(tmp_path.iterdir())) == 1


@pytest.mark.parametrize("options", [Options(jobs=0), Options(seeds=0)])
def test_numbers_below_one_are_refused(options: Options) -> None:
    with pytest.raises(ScenarioError, match="0: at least 1"):
        paper("pliego2023", options)
