"""`hilbed vision` as a user runs it: numbers, page and exit status."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from hilbed.cli import main
from tests.program.hilbed import hilbed
from tests.report.test_report import Page
from tests.vision_kit.scenes import SMALL, dataset

SETTINGS = [word for setting in SMALL for word in ("--set", setting)]
LAX = ["--set", "vision.criteria={recall: {min: 0.5}}"]


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("vision") / "out"
    ended = hilbed("vision", "vision/clean", *SETTINGS, *LAX, "-n", "6", "--out", folder)
    assert ended.status == 0, ended.err
    assert f"page: {folder / 'vision.html'}" in ended.out
    return folder


def test_numbers_and_page_are_left_behind(done: Path) -> None:
    verdict = json.loads((done / "vision.json").read_text())
    assert verdict["passed"]
    assert verdict["measures"]["frames"] == 6
    assert verdict["criteria"] == {
        "recall": {"value": verdict["measures"]["recall"], "limit": 0.5, "passed": True, "bound": "min"}
    }


def test_the_page_is_whole_and_needs_nothing_from_elsewhere(done: Path) -> None:
    text = (done / "vision.html").read_text()
    page = Page(text)
    assert page.open == []
    assert page.titles == [
        "Criteria", "Measures", "Error of the azimuth, by distance", "Error of the azimuth, by direction",
        "Error of the azimuth, in pixels", "Is the stated standard deviation right?", "Found, by distance",
        "Found, by what is visible", "Found, by light", "Time of a frame", "Worst frames", "Scenario",
    ]  # fmt: skip
    assert [one for one in page.loads if not one.startswith(("data:image/png;base64,", "#"))] == []
    assert not re.search(r"url\((?!#)", text)
    assert "#0a0b" not in text, "every stand-in colour has become a variable of the page"
    assert "nan" not in text.split("<pre>")[0].lower().split()


def test_a_missed_criterion_is_status_1_and_json_is_alone_on_stdout(tmp_path: Path) -> None:
    strict = ["--set", "vision.criteria={azimuth_std_mdeg: {max: 0.001}}"]
    ended = hilbed(
        "vision", "vision/clean", *SETTINGS, *strict, "-n", "3", "--json", "--out", tmp_path / "out"
    )
    assert ended.status == 1
    verdict = json.loads(ended.out)
    assert "azimuth_std_mdeg: " in verdict["reason"]
    assert "is above 0.001" in verdict["reason"]


def test_a_dataset_scores_as_the_scenario_it_was_made_from(done: Path, tmp_path: Path) -> None:
    folder = dataset(tmp_path / "dataset", frames=6)
    ended = hilbed("vision", folder, *LAX, "--json", "--out", tmp_path / "out")
    assert ended.status == 0, ended.err
    rendered = json.loads((done / "vision.json").read_text())
    read = json.loads(ended.out)
    for name, value in rendered["measures"].items():
        if not name.startswith("time"):
            assert read["measures"][name] == value
    assert read["worst"] == rendered["worst"]


FOREIGN = """
class Blind:
    def __init__(self):
        self.frames = 0
    def detect(self, shot):
        self.frames += 1
        if self.frames == 2:
            raise RuntimeError("no idea")
        return [(0.1, 1e-3, shot.lens.column(0.1), 0)]
"""


def test_a_foreign_detector_is_scored_with_its_failures(tmp_path: Path) -> None:
    (tmp_path / "blind.py").write_text(FOREIGN)
    lax = ["--set", "vision.criteria={failed_frames: {max: 0}}"]
    ended = hilbed(
        "vision", "vision/clean", *SETTINGS, *lax, "-n", "3", "--json", "--out", tmp_path / "out",
        "--detector", tmp_path / "blind.py",
    )  # fmt: skip
    assert ended.status == 1, ended.err
    verdict = json.loads(ended.out)
    assert verdict["detector"] == "blind.py"
    assert verdict["measures"]["failed_frames"] == 1
    assert "no idea" in verdict["failed"]["1"]
    page = Page((tmp_path / "out/vision.html").read_text())
    assert "Frames without an answer" in page.titles


def test_why_a_detector_has_no_answer_is_told_once_with_what_it_printed(tmp_path: Path) -> None:
    code = (
        "class Loud:",
        "    def detect(self, shot):",
        "        print('so be it')",
        "        raise ValueError('no idea')",
    )
    (tmp_path / "loud.py").write_text("\n".join(code))
    ended = hilbed(
        "vision", "vision/clean", *SETTINGS, *LAX, "-n", "3", "--out", tmp_path / "out",
        "--detector", f"{tmp_path / 'loud.py'}:Loud",
    )  # fmt: skip
    assert ended.status == 1
    (line,) = [line for line in ended.out.splitlines() if "no idea" in line]
    assert re.fullmatch(r"frame 0: raised: .*loud\.py:4 in detect: ValueError: no idea", line)
    assert "  | so be it" in ended.out.splitlines()


def test_what_is_there_is_not_overwritten(done: Path, tmp_path: Path) -> None:
    again = ("vision", "vision/clean", *SETTINGS, *LAX, "-n", "2", "--out")
    before = (done / "vision.json").read_bytes()
    ended = hilbed(*again, done)
    assert (ended.status, ended.out) == (4, "")
    assert "--force" in ended.err
    assert (done / "vision.json").read_bytes() == before
    (tmp_path / "thesis.tex").write_text("years of work")
    ended = hilbed(*again, tmp_path, "--force")
    assert ended.status == 4
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["vision/clean", "--set", "vision.criteria.recal.min=1"], "did you mean 'recall'?"),
        (
            ["vision/clean", "--set", "sensors={}", "--set", "estimator=odometry"],
            "no camera among its sensors",
        ),
        (["vision/clean", "--set", "vision.camera=cam"], "there is no camera 'cam'; did you mean 'camera'?"),
        (["vision/claen"], "did you mean 'vision/clean'?"),
        (["bui2022/open-loop", "--set", "vision.poses=path"], "no camera among its sensors"),
        (["vision/clean", "--sweep", "sensors.camera.noise"], "give PATH=V1,V2"),
        (["vision/clean", "--sweep", "sensors.camera.noize=1,2"], "did you mean 'noise'?"),
        (["vision/clean", "--sweep", "sensors.camera.noise=1,2", "--seeds", "x"], "--seeds x"),
        (["vision/clean", "--sweep", "sensors.camera.noise=0", "--jobs", "0"], "at least one process"),
        (["vision/clean", "--vary", "sensors.camera.gain=1,"], "give PATH=V1,V2"),
        (["vision/clean", "--vary", "sensors.camera.gain=1,0"], "sensors.camera.gain"),
        (["vision/clean", "-n", "0"], "at least one frame"),
        (["vision/clean", "-n", "many"], "invalid int value"),
    ],
)
def test_a_mistake_is_told_before_anything_is_done(
    arguments: list[str], told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["vision", *arguments, "--out", str(tmp_path / "out")])
    out, err = capsys.readouterr()
    assert (ended.value.code, out) == (4, "")
    assert told in err
    assert "Traceback" not in err
    assert not (tmp_path / "out").exists()


def test_a_scenario_without_beacons_has_frames_and_no_recall(tmp_path: Path) -> None:
    empty = [
        "--set", "plant.beacons=[]", "--set", "estimator=odometry", "--set", "vision.criteria={}",
        "--set", "vision.poses=random",
    ]  # fmt: skip
    ended = hilbed(
        "vision", "vision/clean", *SETTINGS, *empty, "-n", "2", "--json", "--out", tmp_path / "out"
    )
    assert ended.status == 0, ended.err
    measures = json.loads(ended.out)["measures"]
    assert (measures["frames"], measures["beacons"], measures["recall"]) == (2, 0, None)


def test_frames_with_several_values_are_one_score_from_dark_to_bright(tmp_path: Path) -> None:
    ended = hilbed(
        "vision", "vision/clean", *SETTINGS, *LAX, "-n", "4", "--json", "--out", tmp_path / "out",
        "--vary", "sensors.camera.gain=0.01,1",
    )  # fmt: skip
    verdict = json.loads(ended.out)
    dark, bright = verdict["varied"]["sensors.camera.gain=0.01"], verdict["varied"]["sensors.camera.gain=1"]
    assert (dark["recall"], verdict["measures"]["frames"]) == (0.0, 8)
    assert bright["recall"] > 0.5
    assert verdict["measures"]["recall"] == pytest.approx(bright["recall"] / 2), "the same beacons in both"
    assert {frame // 4 for frame in verdict["worst"]} == {0, 1}, "frames are numbered on"
    page = Page((tmp_path / "out/vision.html").read_text())
    assert "By value" in page.titles


def test_a_sweep_takes_somebodys_detector(tmp_path: Path) -> None:
    (tmp_path / "blind.py").write_text("class Blind:\n    def detect(self, shot):\n        return []\n")
    ended = hilbed(
        "vision", "vision/clean", *SETTINGS, "--set", "duration=1", "--set", "criteria={}", "--jobs", "1",
        "--sweep", "sensors.camera.noise=0", "--detector", tmp_path / "blind.py", "--json",
        "--out", tmp_path / "out",
    )  # fmt: skip
    assert ended.status == 0, ended.err
    (run,) = json.loads(ended.out)["runs"]
    assert not run["azimuth_count"]


def test_a_sweep_shows_every_effect_in_one_figure(tmp_path: Path) -> None:
    ended = hilbed(
        "vision", "vision/clean", *SETTINGS, "--set", "duration=2", "--set", "criteria={}", "--jobs", "1",
        "--sweep", "sensors.camera.noise=0,0.01", "--seeds", "1..2", "--out", tmp_path / "out",
    )  # fmt: skip
    assert ended.status == 0, ended.err
    content = json.loads((tmp_path / "out/sweep.json").read_text())
    assert [(run["value"], run["seed"]) for run in content["runs"]] == [
        ("0", 1), ("0", 2), ("0.01", 1), ("0.01", 2),
    ]  # fmt: skip
    clean, noisy = content["runs"][0], content["runs"][2]
    assert noisy["azimuth_rms_mdeg"] > 4 * clean["azimuth_rms_mdeg"]
    page = Page((tmp_path / "out/sweep.html").read_text())
    assert page.open == []
    assert page.figures == [
        "effects of the degradation",
        "sensors.camera.noise=0",
        "sensors.camera.noise=0.01",
    ]
