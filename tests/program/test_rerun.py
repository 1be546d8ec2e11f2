"""A run folder is enough to run again: the resolved scenario and the scenario's own files lie in it."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from hilbed.resources import package_file
from tests.program.hilbed import hilbed
from tests.recorded import files

# Pyramid: half a metre above the ground, so that it touches nothing.
MESH = "v 0 0 .6\nv .1 0 .5\nv 0 .1 .5\nv 0 0 .5\nf 1 2 3\nf 1 3 4\nf 1 2 4\nf 2 3 4\n"
COLLISION = (
    '<collision><geometry><mesh filename="../meshes/tower.obj"/></geometry></collision>'
    '<visual><geometry><mesh filename="package://elsewhere/hull.dae"/></geometry></visual>'
)
DRIVING = """
duration: 0.2
robot: {kind: diffdrive, urdf: bodies/own.urdf}
plant: {kind: bullet}
estimator: odometry
controller: open_loop
reference: {kind: line, length: 10, speed: 0.5}
record: signals
"""
PLAYING = """
duration: 0.9
period: 0.1
plant: {kind: recorded, file: log.npz}
estimator: odometry
record: signals
"""


def driving(folder: Path) -> Path:
    """Writes a scenario with a body of its own, whose mesh lies in another folder."""
    (folder / "bodies").mkdir(parents=True)
    (folder / "meshes").mkdir()
    text = package_file("urdf/diffdrive.urdf").read_text()
    heavier = text.replace('<mass value="8.0"/>', '<mass value="9.5"/>')
    assert heavier != text
    (folder / "bodies" / "own.urdf").write_text(heavier.replace("<collision", f"{COLLISION}<collision", 1))
    (folder / "meshes" / "tower.obj").write_text(MESH)
    (folder / "own.yaml").write_text(DRIVING)
    return folder / "own.yaml"


def playing(folder: Path) -> Path:
    """Writes a scenario that plays a recording of its own."""
    folder.mkdir()
    files.write(folder).rename(folder / "log.npz")
    (folder / "own.yaml").write_text(PLAYING)
    return folder / "own.yaml"


def run(scenario: Path | str, out: Path, cwd: Path) -> str:
    """Runs a scenario from a folder and returns its hash."""
    ended = hilbed("run", scenario, "--out", out, "--force", cwd=cwd)
    assert ended.status in (0, 1), ended.err
    return str(json.loads((out / "verdict.json").read_text())["hash"])


@pytest.mark.parametrize(
    ("write", "kept"),
    [(driving, {"bodies/own.urdf", "meshes/tower.obj"}), (playing, {"log.npz"})],
    ids=["urdf", "recording"],
)
def test_from_another_folder_with_the_first_one_gone(
    write: Callable[[Path], Path], kept: set[str], tmp_path: Path
) -> None:
    there, elsewhere = tmp_path / "there", tmp_path / "elsewhere"
    elsewhere.mkdir()
    first = run(write(there), elsewhere / "first", cwd=there)
    shutil.rmtree(there)
    own = elsewhere / "first" / "files"
    assert {path.relative_to(own).as_posix() for path in own.rglob("*") if path.is_file()} == kept
    second = elsewhere / "second"
    assert run("first/scenario.yaml", second, cwd=elsewhere) == first
    assert run(second / "scenario.yaml", second, cwd=tmp_path) == first  # into its own place
    assert not (second / "files" / "files").exists()


def test_force_takes_the_old_runs_files_away(tmp_path: Path) -> None:
    run(driving(tmp_path / "there"), tmp_path / "run", cwd=tmp_path)
    stranger = tmp_path / "run" / "files" / "bodies" / "own.urdf"
    assert stranger.exists()
    run(playing(tmp_path / "other"), tmp_path / "run", cwd=tmp_path)
    assert {path.name for path in (tmp_path / "run" / "files").iterdir()} == {"log.npz"}
