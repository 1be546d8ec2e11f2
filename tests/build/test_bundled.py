"""Every bundled scenario is complete, can be built, and survives being written out and read again."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from hilbed import yaml12
from hilbed.build import build
from hilbed.commands import print_scenarios
from hilbed.cost import Cost
from hilbed.record.notes import Notes
from hilbed.scenario import bundled
from hilbed.scenario.load import load, resolved
from hilbed.versions import versions
from tests.bench import needs_data

SCENARIOS = [
    pytest.param(name, marks=needs_data if name.startswith("recorded/") else []) for name in bundled.names()
]


@pytest.mark.parametrize("name", SCENARIOS)
def test_it_has_a_title_and_criteria(name: str) -> None:
    loaded = load(name)
    assert loaded.title
    assert loaded.scenario.criteria, "or its exit status would mean nothing"
    assert loaded.name == name


def test_no_two_have_the_same_title() -> None:
    titles = [bundled.summary(name)[-1] for name in bundled.names()]
    assert len(set(titles)) == len(titles)


@pytest.mark.parametrize("name", SCENARIOS)
def test_written_out_with_every_default_it_is_the_same(name: str, tmp_path: Path) -> None:
    first = load(name)
    text = yaml12.write(resolved(first.scenario, versions()))
    (tmp_path / "again.yaml").write_text(text)
    again = load(str(tmp_path / "again.yaml"))
    assert again.scenario.versions == versions()
    assert again.scenario.model_copy(update={"versions": {}}) == first.scenario
    assert yaml12.write(resolved(again.scenario, versions())) == text


@pytest.mark.parametrize("name", SCENARIOS)
def test_a_rig_comes_out_of_it(name: str) -> None:
    loaded = load(name)
    bench = build(loaded, Notes(), Cost())
    try:
        truth = bench.rig.plant.truth()
        assert truth.t == 0
        told = getattr(loaded.scenario.plant, "start_std", (0.0, 0.0, 0.0))  # how well the start is known
        assert (np.abs(np.subtract(truth.pose, bench.start)) <= 5 * np.array(told) + 1e-9).all()
        assert bench.rig.period == round(loaded.scenario.period * 1e9)
        assert len(bench.rig.sensors) == len(loaded.scenario.sensors) or name.startswith("recorded/")
        on_the_bus = loaded.scenario.plant.kind == "bullet"
        assert bench.drives == (loaded.scenario.robot.drives if on_the_bus else ())
    finally:
        bench.close()


def test_the_list_is_a_scenario_a_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert print_scenarios() == 0
    assert [line.split("  ")[0] for line in capsys.readouterr().out.splitlines()] == list(bundled.names())


def test_in_a_terminal_the_list_says_what_its_columns_are(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    assert print_scenarios() == 0
    head, *lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == list(bundled.names())
    for word, kind in (("robot", "tricycle"), ("plant", "bullet"), ("controller", "lyapunov")):
        (line,) = [line for line in lines if line.startswith("bui2022/closed-loop-bench ")]
        assert line.index(f" {kind} ") == head.index(f" {word} ")
