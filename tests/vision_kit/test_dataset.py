"""A dataset is the same to the byte however it came about, and says of itself what it is."""

from __future__ import annotations

import json
import resource
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from time import sleep

import cv2
import numpy as np
import pytest

from hilbed import yaml12
from hilbed.types import ScenarioError
from hilbed.vision_kit.archive import Archive
from hilbed.vision_kit.dataset import plan, write_dataset
from tests.program.hilbed import hilbed
from tests.vision_kit.scenes import SMALL, content, dataset, small


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return dataset(tmp_path_factory.mktemp("whole") / "dataset")


def test_it_holds_frames_truth_coco_calibration_and_scenario(whole: Path) -> None:
    assert set(content(whole)) == {
        "dataset.yaml", "scenario.yaml", "truth.jsonl", "coco.json", "calibration.yaml",
        *(f"frames/{k:06d}.png" for k in range(4)),
    }  # fmt: skip
    about, _ = yaml12.read((whole / "dataset.yaml").read_text(), "dataset.yaml")
    assert (about["scenario"], about["seed"], about["frames"]) == ("vision/clean", 1, 4)
    assert "pybullet" in about["versions"]


def test_another_process_writes_the_same_bytes(whole: Path, tmp_path: Path) -> None:
    settings = [word for setting in SMALL for word in ("--set", setting)]
    ended = hilbed("frames", "vision/clean", *settings, "-n", "4", "--out", tmp_path / "again")
    assert (ended.status, ended.out) == (0, f"dataset: {tmp_path / 'again'}\n")
    assert content(tmp_path / "again") == content(whole)


@pytest.mark.parametrize("poses", ["path", "random"])
def test_noise_and_random_poses_come_from_the_seed(tmp_path: Path, poses: str) -> None:
    settings = (f"vision.poses={poses}", "sensors.camera.read_noise=0.1")
    one, same, other = (
        content(dataset(tmp_path / name, *settings, frames=2, seed=seed))
        for name, seed in (("one", 5), ("same", 5), ("other", 6))
    )
    assert one == same
    assert one["frames/000001.png"] != other["frames/000001.png"]


def _killed_in_a_line(folder: Path) -> None:
    lines = (folder / "truth.jsonl").read_text().splitlines(keepends=True)
    (folder / "truth.jsonl").write_text("".join(lines[:2]) + lines[2][:50])


def _killed_before_its_line(folder: Path) -> None:
    lines = (folder / "truth.jsonl").read_text().splitlines(keepends=True)
    (folder / "truth.jsonl").write_text("".join(lines[:2]))
    (folder / "frames/000003.png").unlink()


def _killed_in_a_file(folder: Path) -> None:
    (folder / "truth.jsonl").write_text("")
    (folder / "frames/.000000.png.tmp").write_bytes(b"\x89PNG")


def _killed_before_coco(folder: Path) -> None:
    (folder / "coco.json").unlink()


def _lost_an_image(folder: Path) -> None:
    (folder / "frames/000001.png").unlink()


BREAKS = [_killed_in_a_line, _killed_before_its_line, _killed_in_a_file, _killed_before_coco, _lost_an_image]


@pytest.mark.parametrize("broken", BREAKS)
def test_one_that_was_broken_off_goes_on_to_the_same_bytes(
    whole: Path, tmp_path: Path, broken: Callable[[Path], None]
) -> None:
    folder = dataset(tmp_path / "dataset")
    broken(folder)
    write_dataset(plan(small()), folder, False, lambda _: None)
    assert content(folder) == content(whole)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_one_whose_process_is_ended_goes_on_to_the_same_bytes(tmp_path: Path, number: signal.Signals) -> None:
    settings = [word for setting in SMALL for word in ("--set", setting)]
    command = ["frames", "vision/clean", *settings, "-n", "40", "--out"]
    folder = tmp_path / "dataset"
    process = subprocess.Popen(
        [sys.executable, "-m", "hilbed", *command, str(folder)], stderr=subprocess.PIPE
    )
    while process.poll() is None and len(list((folder / "frames").glob("*.png"))) < 3:
        sleep(0.005)
    process.send_signal(number)
    process.communicate(timeout=60)
    assert process.returncode == (-number if number == signal.SIGKILL else 2)
    assert not (folder / "coco.json").exists(), "it was in the middle of it"
    ended = hilbed(*command, folder)
    assert (ended.status, "were there already" in ended.err) == (0, True)
    assert content(folder) == content(dataset(tmp_path / "fresh", frames=40))


def test_a_full_disk_is_status_3_and_what_is_there_is_of_use(whole: Path, tmp_path: Path) -> None:
    """A limit on the size of files stands for the disk: truth.jsonl grows beyond it."""
    settings = [word for setting in SMALL for word in ("--set", setting)]
    command = [sys.executable, "-m", "hilbed", "frames", "vision/clean", *settings, "-n", "4", "--out"]
    folder = tmp_path / "dataset"
    limit = 12 * 1024

    def small_files() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    done = subprocess.run(
        [*command, str(folder)], capture_output=True, text=True, check=False, preexec_fn=small_files
    )
    assert (done.returncode, done.stdout) == (3, "")
    assert "dataset: File too large" in done.stderr
    assert done.stderr.count("\n") == 1
    assert write_dataset(plan(small()), folder, False, lambda _: None) > 0
    assert content(folder) == content(whole)


def test_what_is_there_is_not_rendered_again(whole: Path) -> None:
    written: list[int] = []
    assert write_dataset(plan(small()), whole, False, written.append) == 4
    assert written == []


def test_another_dataset_is_only_replaced_by_force(tmp_path: Path) -> None:
    folder = dataset(tmp_path / "dataset", frames=3)
    with pytest.raises(ScenarioError, match=r"holds another dataset.*--force"):
        write_dataset(plan(small(frames=2)), folder, False, lambda _: None)
    write_dataset(plan(small(frames=2)), folder, True, lambda _: None)
    assert content(folder) == content(dataset(tmp_path / "fresh", frames=2))


def test_a_folder_of_somebody_else_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("years of work")
    for force in (False, True):
        with pytest.raises(ScenarioError, match="holds no dataset"):
            write_dataset(plan(small()), tmp_path, force, lambda _: None)
    assert content(tmp_path) == {"thesis.tex": b"years of work"}


def test_the_calibration_projects_axes_where_the_truth_says(tmp_path: Path) -> None:
    """OpenCV's own reader and projectPoints, with distortion and tilt; truth from truth.jsonl alone."""
    flaws = (
        "k1=-0.2", "k2=0.05", "p1=0.002", "p2=-0.001", "tilt_deg=5", "cx=83.0", "width=160", "height=120",
    )  # fmt: skip
    folder = dataset(tmp_path / "dataset", *(f"sensors.camera.{flaw}" for flaw in flaws))
    storage = cv2.FileStorage(str(folder / "calibration.yaml"), cv2.FILE_STORAGE_READ)
    matrix = storage.getNode("camera_matrix").mat()
    distortion = storage.getNode("distortion_coefficients").mat()
    beacons = small().scenario.plant.beacons  # type: ignore[union-attr]
    seen = 0
    for line in (folder / "truth.jsonl").read_text().splitlines():
        frame = json.loads(line)
        view = frame["view"]
        for beacon in frame["beacons"]:
            if beacon["box"] is None:
                continue
            seen += 1
            place = (*beacons[beacon["beacon"]].at, 0.25)
            pixel = _project(np.array([place]), view, matrix, distortion)
            assert pixel == pytest.approx([beacon["column"], beacon["row"]], abs=0.01)
    assert seen > 4


def _project(
    points: np.ndarray, view: dict[str, float], matrix: np.ndarray, distortion: np.ndarray
) -> object:  # type: ignore[type-arg]
    """Returns the pixel of a point (1, 3) in the map."""
    yaw, pitch = view["yaw"], view["pitch"]
    turn = np.array([[np.cos(yaw), np.sin(yaw), 0], [-np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])
    down = np.array([[np.cos(pitch), 0, -np.sin(pitch)], [0, 1, 0], [np.sin(pitch), 0, np.cos(pitch)]])
    optical = np.array([[0, -1, 0], [0, 0, -1], [1, 0, 0]])  # forward, left, up → right, down, forward
    rotation = optical @ down @ turn
    eye = np.array([view["x"], view["y"], view["z"]])
    pixels, _ = cv2.projectPoints(points, cv2.Rodrigues(rotation)[0], -rotation @ eye, matrix, distortion)
    return pixels.ravel()


def test_coco_has_the_boxes_round_the_coloured_pixels(whole: Path) -> None:
    """Each box is the smallest one round the pixels of its beacon's own colour."""
    coco = json.loads((whole / "coco.json").read_text())
    categories = {one["id"]: one["name"] for one in coco["categories"]}
    assert [categories[k + 1].split()[0] for k in range(12)] == [str(k) for k in range(12)]
    files = {one["id"]: one["file_name"] for one in coco["images"]}
    hues = {"red": (0, 0, 255), "yellow": (0, 255, 255), "lime": (0, 255, 128), "green": (0, 255, 0)}
    compared = 0
    for one in coco["annotations"]:
        colour = hues.get(categories[one["category_id"]].split()[1])
        if colour is None:
            continue
        image = cv2.imread(str(whole / files[one["image_id"]]))
        rows, columns = (np.abs(image.astype(int) - colour).max(axis=2) < 3).nonzero()
        left, top, width, height = one["bbox"]
        assert (columns.min(), rows.min()) == pytest.approx((left, top), abs=1)
        assert (columns.max(), rows.max()) == pytest.approx((left + width - 1, top + height - 1), abs=1)
        compared += 1
    assert compared > 2


def test_it_is_read_back_as_it_was_taken(whole: Path) -> None:
    from hilbed.vision_kit.studio import Studio, Subject

    archive = Archive(whole)
    with Studio(Subject(small())) as studio:
        for read, taken in zip(archive.shots(), studio, strict=True):
            assert np.array_equal(read.shot.image, taken.shot.image)
            assert repr(read.truth) == repr(taken.truth), "with NaN, which is not equal to itself"
            assert read.shot.lens == taken.shot.lens
