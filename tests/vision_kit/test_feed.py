"""`hilbed vision` on frames that have no truth: images, videos, a live camera, a recorded run."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from re import search
from typing import Any

import numpy as np
import pytest

from hilbed.types import ScenarioError
from hilbed.vision.image_file import read_image
from hilbed.vision.lens import Lens
from hilbed.vision.log_frames import LogFrames
from hilbed.vision.seams import Shot
from tests.program.hilbed import Ended, hilbed
from tests.vision.foreign import write
from tests.vision.mjpeg import camera
from tests.vision.test_sources import calibrate, movie, save

MIDDLE = """
class Middle:
    def detect(self, shot):
        print("light", int(shot.image.mean()))
        return [(shot.lens.azimuth(40.0), 1e-3, 40.0, 11)]
"""


def lines(ended: Ended) -> list[dict[str, Any]]:
    return [json.loads(line) for line in ended.out.splitlines()]


@pytest.fixture
def middle(tmp_path: Path) -> Path:
    path = tmp_path / "middle.py"
    path.write_text(MIDDLE)
    return path


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runs") / "demo"
    ended = hilbed("run", "demo", "--set", "duration=1", "--set", "criteria={}", "--out", folder)
    assert ended.status == 0, ended.err
    return folder


def test_a_folder_of_images_with_a_calibration(tmp_path: Path, middle: Path) -> None:
    for k in range(3):
        save(tmp_path / f"{k}.png", np.full((48, 64, 3), 10 * k, np.uint8))
    lens = Lens(64, 48, 50.0, 51.0, 31.0, 24.0, -0.1, 0.02, 0.001, 0.002, 0.003)
    calibrate(tmp_path / "calibration.yaml")
    ended = hilbed("vision", tmp_path, "--detector", middle, "--rate", "10", "-n", "2")
    assert ended.status == 0, ended.err
    found = lines(ended)
    assert [(line["frame"], line["t"]) for line in found] == [(0, 0.0), (1, 0.1)]
    assert found[0]["detections"] == [
        {"azimuth": lens.azimuth(40.0), "std": 1e-3, "column": 40.0, "beacon": 11, "row": None}
    ]
    assert all(line["seconds"] > 0 for line in found)
    assert "light 10" in ended.err
    assert "2 frames; " in ended.err


def test_a_video_without_a_calibration_says_what_it_takes_for_granted(tmp_path: Path, middle: Path) -> None:
    video = movie(tmp_path / "v.avi")
    ended = hilbed("vision", video, "--detector", middle)
    assert ended.status == 0
    assert "a field of view of 90°" in ended.err
    assert len(lines(ended)) == 10
    told = hilbed("vision", video, "--detector", middle, "--fov-deg", "60")
    assert "no calibration" not in told.err
    assert lines(told)[0]["detections"][0]["azimuth"] == Lens.of_fov(64, 48, np.pi / 3).azimuth(40.0)


def test_a_live_camera(middle: Path) -> None:
    with camera(frames=200) as url:
        ended = hilbed("vision", url, "--detector", middle, "--fov-deg", "60", "-n", "3")
    assert ended.status == 0, ended.err
    assert len(lines(ended)) == 3


def test_a_live_camera_that_stalls_ends_with_a_message(middle: Path) -> None:
    with camera(frames=30, stalls=True) as url:
        ended = hilbed("vision", url, "--detector", middle, "--fov-deg", "60", "--timeout", "1")
    assert ended.status == 3
    assert "no frame for 1 s" in ended.err
    assert "Traceback" not in ended.err


def test_frames_without_an_answer_make_the_status(tmp_path: Path) -> None:
    ended = hilbed("vision", movie(tmp_path / "v.avi"), "--detector", f"{write(tmp_path)}:Raises", "-n", "2")
    assert ended.status == 1
    assert [line["failed"].split(":")[0] for line in lines(ended)] == ["raised", "raised"]
    assert "2 frames, 2 without an answer" in ended.err


def test_a_run_s_frames_give_the_detections_that_it_recorded(run: Path) -> None:
    shown = [(line, one) for line in lines(hilbed("vision", run)) for one in line["detections"]]
    found = np.array([(line["t"], one["beacon"], one["std"]) for line, one in shown])
    signals = np.load(run / "signals.npz")
    names = ("azimuth/t", "azimuth/claimed", "azimuth/std")
    recorded = np.column_stack([signals[name].reshape(-1) for name in names])
    assert len(recorded) > 20
    assert found[: len(recorded)] == pytest.approx(recorded, abs=1e-15)


@pytest.mark.parametrize("part", [0.0, 0.001, 0.3, 0.5, 0.7, 0.999])
def test_of_a_log_that_is_cut_off_the_frames_before_are_read(run: Path, tmp_path: Path, part: float) -> None:
    data, path, lens = (run / "log.mcap").read_bytes(), tmp_path / "log.mcap", Lens.of_fov(640, 64, np.pi / 2)
    path.write_bytes(data[: int(part * len(data))])
    shots: list[Shot] = []
    with pytest.raises(ScenarioError, match=r"log\.mcap: is cut off"):
        shots.extend(LogFrames(path, lens, 0).frames())
    assert [shot.t for shot in shots] == [10**9 + count * 10**8 for count in range(len(shots))]
    assert len(shots) >= (8 if part > 0.9 else 1 if part >= 0.5 else 0)


def test_a_log_of_another_camera_or_of_none_is_told(run: Path, tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match="a frame has 640×64 pixels; the run's camera has 320×64"):
        next(LogFrames(run / "log.mcap", Lens.of_fov(320, 64, 1.0), 0).frames())
    with pytest.raises(ScenarioError, match="only a run with record: all has its frames"):
        LogFrames(tmp_path / "log.mcap", Lens.of_fov(320, 64, 1.0), 0)


def test_a_log_without_the_package_that_reads_it_is_told(run: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mcap.reader", None)
    with pytest.raises(ScenarioError, match="pip install mcap"):
        LogFrames(run / "log.mcap", Lens.of_fov(640, 64, 1.0), 0)


def test_a_run_s_frames_for_another_detector(run: Path, tmp_path: Path) -> None:
    ended = hilbed("vision", run / "log.mcap", "--detector", f"{write(tmp_path)}:Fixed")
    assert ended.status == 0, ended.err
    assert len(lines(ended)) >= 11


def test_the_frames_that_a_run_keeps_as_images_have_its_times(run: Path, middle: Path) -> None:
    ended = hilbed("vision", run / "frames", "--detector", middle, "--like", run / "scenario.yaml")
    kept = [json.loads(line)["t"] for line in (run / "frames" / "frames.jsonl").read_text().splitlines()]
    assert [line["t"] for line in lines(ended)] == kept
    light = [f"light {int(read_image(path).mean())}" for path in sorted((run / "frames").glob("*.png"))]
    assert [line for line in ended.err.splitlines() if line.startswith("light")] == light


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["{images}"], "which detector\\? --detector names one"),
        (["{images}", "--detector", "colr"], "--detector colr: .*neither a kind"),
        (["{images}", "--detector", "colour", "--fov-deg", "180"], "--fov-deg 180"),
        (["{images}", "--detector", "colour", "--rate", "0"], "--rate 0"),
        (["{images}", "--detector", "colour", "-n", "0"], "-n 0: at least one"),
        (["{images}", "--detector", "colour", "--like", "demo"], "does not fit: .* of 640×64 pixels"),
        (["{images}", "--detector", "colour", "--calibration", "{images}/none.yaml"], "No such file"),
        (["{images}", "--detector", "colour", "--set", "seed=1"], "--set needs a scenario"),
        (["{empty}", "--detector", "colour"], "there is no image in it"),
        (["nowhere.mp4", "--detector", "colour"], "there is no file nowhere.mp4"),
        (["nowhere.mcap"], "there is no file nowhere.mcap"),
        (["77", "--detector", "colour"], "camera 77: cannot be opened"),
    ],
)
def test_what_cannot_be_is_refused(tmp_path: Path, words: list[str], told: str) -> None:
    images, empty = tmp_path / "images", tmp_path / "empty"
    images.mkdir()
    empty.mkdir()
    save(images / "a.png")
    ended = hilbed("vision", *(word.format(images=images, empty=empty) for word in words))
    assert ended.status == 4
    assert "Traceback" not in ended.err
    assert search(told, ended.err)
    assert ended.out == ""


def test_a_truncated_image_ends_with_a_message_after_what_came_before(tmp_path: Path, middle: Path) -> None:
    save(tmp_path / "a.png")
    data = save(tmp_path / "b.png").read_bytes()
    (tmp_path / "b.png").write_bytes(data[: len(data) // 2])
    ended = hilbed("vision", tmp_path, "--detector", middle, "--fov-deg", "60")
    assert ended.status == 4
    assert len(lines(ended)) == 1
    assert "b.png: the image is cut off" in ended.err
