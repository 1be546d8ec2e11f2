"""The pytest plugin as a third party meets it: pytest in a process of its own, in an empty folder."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import cv2
import pytest

ROOT = Path(__file__).parents[2]

SMALL = "set=['sensors.camera.width=160', 'sensors.camera.height=32']"
HEAD = f"""
import pytest
from hilbed.testing import assert_azimuths
from hilbed.vision.detect import ColourDetector
pytestmark = pytest.mark.hilbed(frames=3, {SMALL})
"""


def third_party(folder: Path, text: str, *options: str) -> subprocess.CompletedProcess[str]:
    """Runs a test file with the plugin, whether or not hilbed is installed with its entry points."""
    (folder / "test_mine.py").write_text(text)
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
    command = [sys.executable, "-m", "pytest", "-q", "-p", "hilbed.testing.plugin", "-p", "no:cacheprovider"]
    return subprocess.run(
        [*command, "--strict-markers", "--no-header", "test_mine.py", *options],
        cwd=folder, env=environment, capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip


GOOD = """
def test_frame(hilbed_frame):
    assert hilbed_frame.shot.image.shape == (32, 160, 3)
    assert len(hilbed_frame.truth.beacons) == 12

@pytest.mark.hilbed_degraded(clean="", noise=["sensors.camera.read_noise=0.01", "sensors.camera.bits=7"])
def test_path(hilbed_camera, hilbed_degradation):
    detector = ColourDetector(hilbed_camera.lens, hilbed_camera.beacons)
    frames = list(hilbed_camera)
    assert len(frames) == 3 and len({frame.truth.t for frame in frames}) == 3
    levels = {level for frame in frames for level in frame.shot.image.ravel().tolist()}
    assert (len(levels) > 10) == bool(hilbed_degradation)
    for frame in frames:
        assert_azimuths(detector.detect(frame.shot), frame, within=0.01, distance=(0.0, 4.0))

def test_standing_still(hilbed_camera):
    frame = hilbed_camera.at(5.0, 0.0, 0.0)
    assert frame.truth.body == (5.0, 0.0, 0.0)
    assert frame.truth.beacons[0].azimuth == 0.0 and frame.truth.beacons[0].distance == 2.0

def test_dataset(hilbed_dataset):
    assert len(hilbed_dataset) == len(list((hilbed_dataset.folder / "frames").iterdir())) == 3
    for frame in hilbed_dataset.shots():
        assert frame.shot.lens == hilbed_dataset.lens
"""


def test_fixtures_show_frames_with_truth(tmp_path: Path) -> None:
    done = third_party(tmp_path, HEAD + GOOD, "-rA")
    assert done.returncode == 0, done.stdout
    assert "test_path[clean]" in done.stdout
    assert "test_path[noise]" in done.stdout
    assert "5 passed" in done.stdout
    assert not (tmp_path / "hilbed-failures").exists()


BAD = """
def test_wrong(hilbed_camera):
    frame = hilbed_camera.at(0.0, 0.0, 0.0)
    lens, beacons = frame.shot.lens, {one.beacon: one for one in frame.truth.beacons if one.box}
    first, second, third = list(beacons)[:3]
    def seen(beacon, off=0.0, named=None):
        azimuth = beacons[beacon].azimuth + off
        return {"azimuth": azimuth, "std": 1e-3, "column": lens.column(azimuth), "beacon": named}
    found = [seen(first, 0.02, first), seen(second, 0.0, 7), seen(third, 0.15)]
    assert_azimuths(found, frame, within=0.01)
"""


def test_a_failure_says_what_is_wrong_and_keeps_the_frame(tmp_path: Path) -> None:
    done = third_party(tmp_path, HEAD + BAD)
    assert done.returncode == 1
    assert re.search(r"beacon \d+ at [-+.\d]+°, [.\d]+ m.*: off by \+1\.15e\+03 mdeg", done.stdout)
    assert re.search(r"beacon \d+ at .*: taken for beacon 7", done.stdout)
    assert re.search(r"beacon \d+ at .*: missed", done.stdout)
    assert re.search(r"detection at .*: no beacon there", done.stdout)
    assert "assertions.py" not in done.stdout, "the traceback ends in the third party's own test"
    kept = tmp_path / "hilbed-failures/test_mine.py-test_wrong.png"
    assert f"frame: hilbed-failures/{kept.name}" in done.stdout
    assert cv2.imread(str(kept)).shape == (32, 160, 3)
    assert cv2.imread(str(kept.with_suffix(".drawn.png"))).shape == (128, 640, 3)


MISTAKES = """
@pytest.mark.hilbed(scenario="vision/claen")
def test_scenario(hilbed_frame): pass

@pytest.mark.hilbed(scenerio="demo")
def test_key(hilbed_frame): pass

@pytest.mark.hilbed_degraded(x="sensors.camera.nose=1")
def test_degradation(hilbed_frame): pass

def test_column(hilbed_frame): assert_azimuths([(1, 2)], hilbed_frame, within=1)

def test_nan(hilbed_frame): assert_azimuths([(0, float("nan"), 1)], hilbed_frame, within=1)
"""
TOLD = (
    "did you mean 'vision/clean'?", "takes scenario, frames, seed, set by name, not scenerio",
    "did you mean 'noise'?", "a detection states no column", "not finite",
)  # fmt: skip


def test_a_mistake_is_told_by_its_message(tmp_path: Path) -> None:
    done = third_party(tmp_path, HEAD + MISTAKES)
    assert "2 failed, 3 errors" in done.stdout
    assert [told for told in TOLD if told not in done.stdout] == []


def test_a_degradation_of_nothing_is_a_mistake(tmp_path: Path) -> None:
    done = third_party(tmp_path, HEAD + "@pytest.mark.hilbed_degraded(x='')\ndef test_it(): pass")
    assert done.returncode == pytest.ExitCode.INTERRUPTED, "while it collects tests"
    assert "is for tests with hilbed_frame, hilbed_camera" in done.stdout
    assert "Traceback" not in done.stdout


LIGHT = """
import sys
def test_nothing_heavy_was_imported():
    heavy = {"numpy", "cv2", "pybullet", "pydantic", "yaml", "scipy", "matplotlib"} & set(sys.modules)
    assert not heavy
    assert {name for name in sys.modules if name.startswith("hilbed")} <= {
        "hilbed", "hilbed.testing", "hilbed.testing.assertions", "hilbed.testing.plugin"}
"""


def test_a_run_that_does_not_use_it_is_left_alone(tmp_path: Path) -> None:
    done = third_party(tmp_path, LIGHT)
    assert done.returncode == 0, done.stdout
    assert {path.name for path in tmp_path.iterdir()} <= {"test_mine.py", "__pycache__"}
