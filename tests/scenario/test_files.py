"""Where a scenario may read: its own folder, the package, HILBED_DATA; nowhere else."""

from __future__ import annotations

from pathlib import Path

import pytest

from hilbed.resources import package_file
from hilbed.scenario import files
from hilbed.scenario.load import load
from hilbed.types import ScenarioError

SCENARIO = """
duration: 1
robot: {kind: diffdrive, urdf: robot.urdf}
plant: {kind: bullet}
estimator: odometry
controller: open_loop
reference: {kind: line, length: 10, speed: 0.5}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A scenario's folder, with a secret beside it and a link that leads there."""
    (tmp_path / "secret").write_text("not yours")
    own = tmp_path / "own"
    (own / "bodies").mkdir(parents=True)
    (own / "bodies" / "a.urdf").write_text("<robot/>")
    (own / "mesh.obj").write_text("v 0 0 0")
    (own / "link").symlink_to(tmp_path / "secret")
    return own


def test_names_inside_the_folder(folder: Path) -> None:
    assert files.resolve("bodies/a.urdf", folder) == folder / "bodies" / "a.urdf"
    assert files.resolve("bodies/../mesh.obj", folder) == folder / "mesh.obj"
    assert files.beside("../mesh.obj", "bodies/a.urdf", folder) == folder / "mesh.obj"


@pytest.mark.parametrize(
    "name", ["../secret", "link", "bodies/../../secret", "/etc/passwd", "data:../secret"]
)
def test_names_that_lead_out(name: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HILBED_DATA", str(folder))
    with pytest.raises(ScenarioError, match="leaves"):
        files.resolve(name, folder)
    assert not name.startswith("data:") or files.resolve("data:mesh.obj", folder).name == "mesh.obj"


@pytest.mark.parametrize("other", ["../../secret", "../link", "/etc/passwd"])
def test_a_file_cannot_lead_out_either(other: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HILBED_DATA", str(folder))
    for name in ("bodies/a.urdf", "data:bodies/a.urdf"):
        with pytest.raises(ScenarioError, match="leaves"):
            files.beside(other, name, folder)
    with pytest.raises(ScenarioError, match="leaves"):
        files.beside("../pyproject.toml", "package:urdf/diffdrive.urdf", folder)


def test_a_mesh_that_is_not_there_is_told_with_the_line(tmp_path: Path) -> None:
    text = package_file("urdf/diffdrive.urdf").read_text()
    mesh = '<collision><geometry><mesh filename="hull.obj"/></geometry></collision>'
    (tmp_path / "robot.urdf").write_text(text.replace("<collision", f"{mesh}<collision", 1))
    (tmp_path / "own.yaml").write_text(SCENARIO)
    with pytest.raises(ScenarioError, match=r"own\.yaml:3: robot\.urdf: there is no file hull\.obj"):
        load(str(tmp_path / "own.yaml"))
