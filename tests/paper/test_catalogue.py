"""What the papers' files name is there, and what follows from it is run."""

from __future__ import annotations

from pathlib import Path

import pytest

from hilbed.criteria import METRICS
from hilbed.paper import NAMES, read
from hilbed.paper.drawings import drawers
from hilbed.paper.plan import End, ends, experiments, variants
from hilbed.scenario import bundled
from hilbed.scenario.load import load
from hilbed.types import ScenarioError
from tests.paper.small import ONE, SEEN, small


@pytest.mark.parametrize("name", NAMES)
def test_it_names_every_ideal_experiment_and_nothing_else(name: str) -> None:
    known = {one for one in bundled.names() if one.startswith(f"{name}/") and not one.endswith("-bench")}
    content = read(name)
    shown = set(content.scenarios())
    assert shown <= known
    assert all(one.endswith("-printed") for one in known - shown)


@pytest.mark.parametrize("name", NAMES)
def test_every_drawing_and_every_number_is_known(name: str) -> None:
    for section in read(name).sections:
        assert {figure.draw for figure in section.figures} <= set(drawers())
        for claim in section.claims:
            assert claim.ours in METRICS or claim.ours == "final" or claim.ours.startswith("cost/")


@pytest.mark.parametrize("name", NAMES)
def test_every_varied_value_makes_a_scenario(name: str) -> None:
    for run in experiments(read(name), Path("p"), ideal=True):
        if run.settings:
            load(run.scenario, run.settings)


@pytest.mark.parametrize(
    ("name", "numbers"),
    [
        ("slimane2014", ["4 a", "4 b", "5 a", "5 b", "6", "7 a, b", "8"]),
        ("ishikawa1994", ["3", "4", "5"]),
        ("lages2017", ["4", "7", "8", "9 a", "9 b", "10", "11", "12", "13 a", "13 b", "14 a", "14 b", "15"]),
    ],
)
def test_figures_come_in_the_papers_order(name: str, numbers: list[str]) -> None:
    named = [figure.name for section in read(name).sections for figure in section.figures if figure.name]
    assert list(dict.fromkeys(named)) == [f"Fig. {number}" for number in numbers]


def test_five_papers_are_there() -> None:
    assert NAMES == ["bui2022", "ishikawa1994", "lages2017", "pliego2023", "slimane2014"]


def test_an_unknown_paper_is_answered_with_the_nearest_name() -> None:
    with pytest.raises(ScenarioError, match="did you mean 'lages2017'"):
        read("lages2018")


def test_twins_follow_their_scenarios_unless_only_the_ideal_is_wanted() -> None:
    names = [run.name for run in experiments(read("pliego2023"), Path("p"), ideal=False)]
    assert names[:2] == [SEEN, f"{SEEN}-bench"]
    assert not any(run.name.endswith("-bench") for run in experiments(small(), Path("p"), ideal=True))


def test_a_value_that_varies_makes_runs_of_its_own() -> None:
    runs = {run.name: run for run in experiments(small(), Path("p"), ideal=True)}
    varied = runs[f"{ONE}@1.5"]
    assert varied == (f"{ONE}@1.5", ONE, Path("p/test1-type1-at-1.5"), ("robot.wheelbase=1.5",))
    figure = small().sections[0].figures[2]
    assert variants(figure) == [(f"{ONE}@1", 1.0), (f"{ONE}@1.5", 1.5)]


def test_tables_ask_for_every_seed_or_for_the_first_of_them() -> None:
    assert ends(small(), None) == [End(ONE, 3), End(ONE, 4), End(ONE, 5)]
    assert ends(small(), 2) == [End(ONE, 3), End(ONE, 4)]
    assert len(ends(read("lages2017"), None)) == 50 + 40
