"""Runs of the bundled scenarios are what they were; `scripts/golden` shows and renews."""

from __future__ import annotations

import pytest

from hilbed.scenario import bundled
from tests.bench import needs_data
from tests.golden.compare import moved
from tests.golden.recording import FOLDER, SETTINGS, path, read, take


def scenarios() -> list[object]:
    marks = {True: [needs_data], False: []}
    return [pytest.param(name, marks=marks[name.startswith("recorded/")]) for name in SETTINGS]


@pytest.mark.parametrize("name", scenarios())
def test_nothing_has_moved(name: str) -> None:
    changes = moved(read(name), take(name))
    assert not changes, "\n".join(map(str, changes))


@pytest.mark.parametrize(
    ("setting", "first"),
    [
        ("plant.encoder.resolution=66001", "truth/"),
        ("plant.supply.resistance=0.0501", "drive/"),
        ("sensors.camera.noise=0.00001", "estimate/"),
        ("estimator.odometry.turn_noise=0.00501", "deviation/"),
        ("controller.error=[0.0501, 0.05, 0.05]", "command/"),
    ],
)
def test_a_small_change_of_any_part_is_noticed(setting: str, first: str) -> None:
    name = "slimane2014/tracking-line"
    changes = moved(read(name), take(name, setting))
    assert any(change.name.startswith(first) for change in changes), changes


PAPERS = (
    "ishikawa1994/",
    "bui2022/",
    "lages2017/",
    "pliego2023/",
    "tricycle/",
    "vision/",  # held by tests/vision_kit: its frames, not its run, are what counts
)  # held by tests/papers, beside the equations


def test_every_other_bundled_scenario_has_a_record_and_every_record_a_scenario() -> None:
    assert set(SETTINGS) == {name for name in bundled.names() if not name.startswith(PAPERS)}
    assert {file.name for file in FOLDER.iterdir()} == {path(name).name for name in SETTINGS}
