"""The wheel holds all of both packages and nothing else, and runs where there is no working copy."""

from __future__ import annotations

import os
import subprocess
import sys
from importlib.metadata import distributions
from pathlib import Path
from zipfile import ZipFile

import pytest

ROOT = Path(__file__).parents[2]
PACKAGES = ("hilbed", "firmware_sim")
SOURCES = {".py", ".typed", ".yaml", ".css", ".eds"}


@pytest.fixture(scope="module")
def unpacked(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel as pip would lay it into site-packages, built with the hatchling of this environment."""
    folder = tmp_path_factory.mktemp("wheel")
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True)
    (wheel,) = folder.glob("*.whl")
    site = folder / "site-packages"
    ZipFile(wheel).extractall(site)
    return site


def installed(site: Path, *command: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    """Runs Python in an empty folder with the unpacked wheel in front of the editable installation."""
    environment = {**os.environ, "PYTHONPATH": str(site)}
    return subprocess.run(
        [sys.executable, *command], cwd=cwd, env=environment, capture_output=True, text=True
    )


def names(folder: Path, *tops: str) -> set[str]:
    files = (path for top in tops for path in (folder / top).rglob("*") if path.is_file())
    return {path.relative_to(folder).as_posix() for path in files}


def test_wheel_has_every_file_of_both_packages_and_the_robots(unpacked: Path) -> None:
    sources = {name for name in names(ROOT, *PACKAGES) if Path(name).suffix in SOURCES}
    assert {"hilbed/scenarios/demo.yaml", "hilbed/report/page.css", "firmware_sim/hilbed402.eds"} < sources
    robots = {f"hilbed/{name}" for name in names(ROOT, "urdf")}
    assert names(unpacked, *PACKAGES) == sources | robots


def test_wheel_has_nothing_beside_the_packages(unpacked: Path) -> None:
    tops = {path.name for path in unpacked.iterdir() if not path.name.endswith(".dist-info")}
    assert tops == set(PACKAGES)


def test_wheel_names_its_command_its_bus_and_its_licence(unpacked: Path) -> None:
    (found,) = distributions(path=[str(unpacked)])
    named = {(entry.group, entry.name): entry.value for entry in found.entry_points}
    assert named == {
        ("console_scripts", "hilbed"): "hilbed.cli:main",
        ("can.interface", "hilbed"): "hilbed.can.plugin:HilbedBus",
        ("pytest11", "hilbed"): "hilbed.testing.plugin",
    }
    assert all(entry.load() for entry in found.entry_points)
    assert found.metadata["License-Expression"] == "MIT"
    assert any(str(file).endswith("licenses/LICENSE") for file in found.files or ())


def test_installed_copy_runs_a_scenario_from_an_empty_folder(unpacked: Path, tmp_path: Path) -> None:
    where = installed(unpacked, "-c", "import hilbed; print(hilbed.__file__)", cwd=tmp_path)
    assert Path(where.stdout.strip()).is_relative_to(unpacked)
    run = (
        "-m",
        "hilbed",
        "run",
        "demo",
        "--set",
        "duration=0.5",
        "--set",
        "criteria.odometry_over_estimate.min=0",
    )
    done = installed(unpacked, *run, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "runs/demo-1/report.html").is_file()


def test_a_third_party_tests_its_detector_with_the_installed_copy(unpacked: Path, tmp_path: Path) -> None:
    """The README's own test file, by the plugin that pytest finds by itself."""
    readme = (ROOT / "README.md").read_text()
    blocks = [block for block in readme.split("```python\n")[1:] if "assert_azimuths" in block]
    text = blocks[0].partition("```")[0]
    assert len([line for line in text.splitlines() if line.strip()]) <= 10, "it is ten lines"
    (tmp_path / "test_detector.py").write_text(text)
    options = ("-m", "pytest", "-q", "-p", "no:cacheprovider", "test_detector.py")
    done = installed(unpacked, *options, cwd=tmp_path)
    assert done.returncode == 0, done.stdout
    assert "3 passed" in done.stdout
