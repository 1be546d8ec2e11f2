"""`hilbed paper`: what its files name is there, its tables are right, and one whole paper runs."""

from __future__ import annotations

import re
from math import pi
from pathlib import Path

import numpy as np
import pytest

from hilbed.criteria import METRICS
from hilbed.paper import NAMES, read
from hilbed.paper.catalogue import Claim, Table
from hilbed.paper.command import PAGE, paper
from hilbed.paper.page import figures
from hilbed.paper.runs import End, final_pose
from hilbed.paper.tables import statistics, value
from hilbed.report.run import read_run
from hilbed.scenario import bundled
from hilbed.types import Pose, ScenarioError
from tests.bench import ran


@pytest.mark.parametrize("name", NAMES)
def test_it_names_every_ideal_experiment_and_nothing_else(name: str) -> None:
    known = {one for one in bundled.names() if one.startswith(f"{name}/") and not one.endswith("-bench")}
    content = read(name)
    drawn = set(content.scenarios())
    unseen = {one for one in known - drawn if not one.endswith("-printed")}
    assert drawn <= known
    assert not unseen
    for section in content.sections:
        assert set(section.draw) <= set(figures())
        for claim in section.claims:
            assert claim.scenario in section.scenarios
            assert claim.ours in METRICS or claim.ours == "final" or claim.ours.startswith("cost/")
        assert section.table is None or set(section.table.scenarios) <= known


def test_five_papers_are_there() -> None:
    assert NAMES == ["bui2022", "ishikawa1994", "lages2017", "pliego2023", "slimane2014"]


def test_an_unknown_paper_is_answered_with_the_nearest_name() -> None:
    with pytest.raises(ScenarioError, match="did you mean 'lages2017'"):
        read("lages2018")


def test_statistics_wrap_the_yaw_and_take_the_sample_standard_deviation() -> None:
    poses = [Pose(1.0, 2.0, pi - 0.1), Pose(1.2, 2.4, -pi + 0.1)]
    table = Table(scenarios=["demo"], seeds=(0, 1), mean=(1.0, 2.0, pi), std=(0.1, 0.1, 0.1))
    text = re.sub(r"<[^>]*>+", " ", statistics(table, poses))
    numbers = [float(number) for number in re.findall(r"-?\d+\.\d+", text)]
    stds = np.std([(1.0, 2.0, -0.1), (1.2, 2.4, 0.1)], axis=0, ddof=1)
    expected = [1.0, 1.1, 0.1, stds[0], 2.0, 2.2, 0.1, stds[1], pi, pi, 0.1, stds[2]]
    assert numbers == pytest.approx(expected, abs=1e-4)


def test_the_end_of_a_run_is_that_of_its_signals() -> None:
    run = ran("lages2017/single", "duration=70", seed=5)
    assert final_pose(End("lages2017/single", 5)) == tuple(run.signals["truth"][-1])


def test_a_whole_paper_runs_and_shows_its_figures(tmp_path: Path) -> None:
    folder = tmp_path / "page"
    assert paper("ishikawa1994", folder, jobs=2, ideal=True, force=False) == 0
    text = (folder / PAGE).read_text()
    content = read("ishikawa1994")
    drawn = sum(len(section.draw) * len(section.scenarios) for section in content.sections)
    assert text.count("<svg") == drawn
    assert text.count("<li>") == len(content.mended) + len(content.free)
    assert "http" not in re.sub(r'xmlns(:\w+)?="[^"]*"', "", text)
    for name in content.scenarios():
        assert (folder / name.rpartition("/")[2] / "report.html").exists()
    with pytest.raises(ScenarioError, match="--force"):
        paper("ishikawa1994", folder, jobs=1, ideal=True, force=False)

    run = read_run(folder / "reverse")
    runs = {"ishikawa1994/reverse": run}
    final = Claim(what="", printed="", scenario="ishikawa1994/reverse", ours="final")
    assert value(final, runs, "") == ", ".join(f"{number:.3f}" for number in run.signals["truth"][-1])
    assert value(final, runs, "-bench") == "–"


def test_a_folder_with_something_else_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "letter.txt").write_text("dear")
    with pytest.raises(ScenarioError, match="something else than a paper"):
        paper("ishikawa1994", tmp_path, jobs=1, ideal=True, force=True)
