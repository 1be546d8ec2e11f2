"""`hilbed sweep` as a process: its runs are the runs that one would make by hand."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from hilbed.runner import perform
from hilbed.scenario.load import load
from tests.build.scenarios import small
from tests.program.hilbed import Ended, hilbed
from tests.vision.foreign import write

LIMIT = "criteria={cross_track_rms: {max: 0.05}, odometry_over_estimate: {min: 0.0001}}"
SETTINGS = (
    "duration=0.5",
    "disturbances=[{kind: wheel_radius, drive: left, size: 1.02, spread: 0.01}]",
    LIMIT,
)


def sweep(folder: Path, *arguments: str) -> Ended:
    settings = [word for setting in SETTINGS for word in ("--set", setting)]
    file = small(folder)
    return hilbed("sweep", file, "--seeds", "1..2", *settings, *arguments, cwd=folder)


@pytest.fixture(scope="module")
def swept(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Ended]:
    folder = tmp_path_factory.mktemp("sweep")
    return folder, sweep(folder, "--set", "controller=lqr,open_loop", "--json", "--jobs", "2")


def test_every_seed_and_value_is_run_in_order(swept: tuple[Path, Ended]) -> None:
    folder, ended = swept
    assert (ended.status, ended.err) == (0, "")
    content = json.loads(ended.out)
    variants = [(*SETTINGS, f"controller={kind}") for kind in ("lqr", "open_loop")]
    assert [(tuple(run["set"]), run["seed"]) for run in content["runs"]] == [
        (variant, seed) for variant in variants for seed in (1, 2)
    ]
    assert [tuple(table["set"]) for table in content["tables"]] == variants
    assert {path.name for path in folder.iterdir()} == {"small.yaml"}, "a sweep writes nothing"


def test_its_runs_are_single_runs_bit_by_bit(swept: tuple[Path, Ended]) -> None:
    folder, ended = swept
    runs: list[dict[str, Any]] = json.loads(ended.out)["runs"]
    assert len({run["hash"] for run in runs}) == 4
    for run in runs:
        single = perform(load(str(folder / "small.yaml"), run["set"], run["seed"]), None).verdict
        assert (single["hash"], single["signals_hash"]) == (run["hash"], run["signals_hash"])
        assert single["metrics"] == run["metrics"]


def test_the_table_sums_them_up(swept: tuple[Path, Ended]) -> None:
    content = json.loads(swept[1].out)
    for table in content["tables"]:
        runs = {run["seed"]: run for run in content["runs"] if run["set"] == table["set"]}
        for line in table["lines"]:
            values = {seed: run["metrics"].get(line["name"]) for seed, run in runs.items()}
            assert (line["low"], line["high"]) == (min(values.values()), max(values.values()))
            least = line["name"] == "odometry_over_estimate" and line["passed"] is not None
            assert values[line["worst"]] == (min if least else max)(values.values())
        assert [line["name"] for line in table["lines"][:2]] == ["cross_track_rms", "odometry_over_estimate"]


def test_one_failed_criterion_of_one_variant_is_status_1(tmp_path: Path) -> None:
    ended = sweep(tmp_path, "--set", "criteria.cross_track_rms.max=0.000001,0.05", "--jobs", "1")
    assert ended.status == 1
    heads = [line for line in ended.out.splitlines() if line.startswith("small ") or "passed" in line]
    assert [head.rpartition(": ")[2] for head in heads] == ["0 of 2 passed", "2 of 2 passed"]


def test_a_run_that_breaks_is_told_and_the_others_go_on(tmp_path: Path) -> None:
    hit = "{kind: push, start: 0.1, size: [-20000, 0], length: 0.2}"
    ended = sweep(tmp_path, "--set", f"disturbances=[],[{hit}]", "--jobs", "2")
    assert ended.status == 1
    assert "2 of 2 passed" in ended.out
    assert "0 of 2 passed" in ended.out
    reasons = [line for line in ended.out.splitlines() if line.startswith("  seed ")]
    assert len(reasons) == 2
    assert all("robot" in reason for reason in reasons)


def test_what_cannot_be_run_is_refused_before_the_first_run(tmp_path: Path) -> None:
    ended = sweep(tmp_path, "--set", "controller=lqr,pid")
    assert (ended.status, ended.out) == (4, "")
    assert "unknown kind 'pid'" in ended.err


def test_a_detector_from_anywhere_is_swept_like_any_other(tmp_path: Path) -> None:
    eyes = write(tmp_path)
    settings = ("--set", "duration=0.5", "--set", "disturbances=[]", "--set", "criteria={}")
    named = ("--seeds", "3", "--json", "--detector")
    ended = hilbed("sweep", "demo", *settings, *named, "eyes.py:Raises", cwd=tmp_path)
    assert (ended.status, ended.err) == (0, "")
    (run,) = json.loads(ended.out)["runs"]
    overlaid = ["duration=0.5", "disturbances=[]", "criteria={}"]
    single = perform(load("demo", overlaid, 3, f"{eyes}:Raises"), None).verdict
    assert single["counts"]["sensors.camera"]["raised"] > 0
    assert (single["hash"], single["signals_hash"]) == (run["hash"], run["signals_hash"])
    refused = hilbed("sweep", "demo", *named, "nowhere.py:Raises", cwd=tmp_path)
    assert refused.status == 4
    assert "--detector nowhere.py:Raises: there is no file" in refused.err
