"""What is wrong with a dataset is told by one line that names the file."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from shutil import copytree

import cv2
import numpy as np
import pytest

from hilbed.types import ScenarioError
from hilbed.vision_kit.archive import Archive
from tests.program.hilbed import hilbed
from tests.vision_kit.scenes import dataset


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return dataset(tmp_path_factory.mktemp("whole") / "dataset", frames=2)


def _half_written(folder: Path) -> None:
    path = folder / "truth.jsonl"
    path.write_text(path.read_text().splitlines(keepends=True)[0])


def _without_header(folder: Path) -> None:
    (folder / "dataset.yaml").unlink()


def _without_count(folder: Path) -> None:
    (folder / "dataset.yaml").write_text("scenario: demo\n")


def _without_truth(folder: Path) -> None:
    (folder / "truth.jsonl").unlink()


def _truth_of_something_else(folder: Path) -> None:
    (folder / "truth.jsonl").write_text('{"frame": 0}\n[]\n')


def _truth_elsewhere(folder: Path) -> None:
    lines = [json.loads(line) for line in (folder / "truth.jsonl").read_text().splitlines()]
    lines[1]["file"] = "../../secret.png"
    (folder / "truth.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines))


def _without_image(folder: Path) -> None:
    (folder / "frames/000001.png").unlink()


def _truncated_image(folder: Path) -> None:
    path = folder / "frames/000001.png"
    path.write_bytes(path.read_bytes()[:60])


def _no_image(folder: Path) -> None:
    (folder / "frames/000001.png").write_text("a picture says more than words")


def _four_channels(folder: Path) -> None:
    cv2.imwrite(str(folder / "frames/000001.png"), np.zeros((32, 160, 4), np.uint8))


def _another_size(folder: Path) -> None:
    cv2.imwrite(str(folder / "frames/000001.png"), np.zeros((32, 161, 3), np.uint8))


def _another_calibration(folder: Path) -> None:
    path = folder / "calibration.yaml"
    path.write_text(path.read_text().replace("image_width: 160", "image_width: 320"))


def _no_calibration(folder: Path) -> None:
    (folder / "calibration.yaml").write_text("%YAML 1.2\n---\nimage_width: 160\n")


def _no_scenario(folder: Path) -> None:
    (folder / "scenario.yaml").write_text("duration: -1\n")


CASES = [
    (_half_written, r"truth\.jsonl: 1 of 2 frames; .* goes on where it stopped"),
    (_without_header, r"is not a dataset: .*dataset\.yaml"),
    (_without_count, r"dataset\.yaml: frames is missing"),
    (_without_truth, r"truth\.jsonl: No such file"),
    (_truth_of_something_else, r"truth\.jsonl:1: no truth of a frame"),
    (_truth_elsewhere, r"truth\.jsonl: .* lies outside the dataset"),
    (_without_image, r"000001\.png: No such file"),
    (_truncated_image, r"000001\.png: .*cut off"),
    (_no_image, r"000001\.png: is no image"),
    (_four_channels, r"000001\.png: has 4 channels"),
    (_another_size, r"000001\.png: is 161×32, but calibration\.yaml is for 160×32"),
    (_another_calibration, r"calibration\.yaml: is not of the camera"),
    (_no_calibration, r"calibration\.yaml: image_height is missing"),
    (_no_scenario, r"scenario\.yaml:1: "),
]


@pytest.mark.parametrize(("spoil", "told"), CASES, ids=[spoil.__name__[1:] for spoil, _ in CASES])
def test_a_broken_dataset_is_told(
    whole: Path, tmp_path: Path, spoil: Callable[[Path], None], told: str
) -> None:
    folder = copytree(whole, tmp_path / "dataset")
    spoil(folder)
    with pytest.raises(ScenarioError, match=told):
        list(Archive(folder).shots())


def test_the_program_refuses_it_without_a_traceback(whole: Path, tmp_path: Path) -> None:
    folder = copytree(whole, tmp_path / "dataset")
    _truncated_image(folder)
    ended = hilbed("vision", folder, "--out", tmp_path / "out")
    assert ended.status == 4
    assert ended.out == ""
    assert ended.err.count("\n") == 1
    assert "000001.png" in ended.err
    assert not (tmp_path / "out").exists()
