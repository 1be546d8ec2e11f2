"""Every bundled scenario is complete, can be built, and survives being written out and read again."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from hilbed.build import build
from hilbed.cost import Cost
from hilbed.record.notes import Notes
from hilbed.scenario import bundled, yaml12
from hilbed.scenario.load import load, resolved
from hilbed.versions import versions

NAMES = bundled.names()
DATA = os.environ.get("HILBED_DATA", "")
has_data = bool(DATA) and Path(DATA, "woods.npz").is_file()


@pytest.fixture
def _any_data(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Enough for a scenario to be valid: the file is there, it need not be read."""
    (tmp_path / "woods.npz").touch()
    monkeypatch.setenv("HILBED_DATA", str(tmp_path))


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.usefixtures("_any_data")
def test_it_has_a_title_and_criteria(name: str) -> None:
    loaded = load(name)
    assert loaded.title
    assert loaded.scenario.criteria, "or its exit status would mean nothing"
    assert loaded.name == name


def test_no_two_have_the_same_title() -> None:
    titles = [bundled.summary(name)[-1] for name in NAMES]
    assert len(set(titles)) == len(titles)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.usefixtures("_any_data")
def test_written_out_with_every_default_it_is_the_same(name: str, tmp_path: Path) -> None:
    first = load(name)
    text = yaml12.write(resolved(first.scenario, versions()))
    (tmp_path / "again.yaml").write_text(text)
    again = load(str(tmp_path / "again.yaml"))
    assert again.scenario.versions == versions()
    assert again.scenario.model_copy(update={"versions": {}}) == first.scenario
    assert yaml12.write(resolved(again.scenario, versions())) == text


@pytest.mark.parametrize("name", NAMES)
def test_a_rig_comes_out_of_it(name: str) -> None:
    if name.startswith("recorded/") and not has_data:
        pytest.skip("HILBED_DATA names no folder with woods.npz")
    loaded = load(name)
    bench = build(loaded, Notes(), Cost())
    try:
        truth = bench.rig.plant.truth()
        assert truth.t == 0
        assert truth.pose == pytest.approx(bench.start)
        assert bench.rig.period == round(loaded.scenario.period * 1e9)
        assert len(bench.rig.sensors) == len(loaded.scenario.sensors) or name.startswith("recorded/")
        assert set(bench.drives) == ({"left", "right"} if not name.startswith("recorded/") else set())
    finally:
        bench.close()
