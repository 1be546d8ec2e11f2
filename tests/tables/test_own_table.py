"""A user's own drive table: read from the scenario's folder, told by file and line, kept with the run."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from hilbed.can.drive_table import TABLES, load_table, named_table, read_table
from hilbed.replay.command import perform as replay
from hilbed.replay.differences import differences
from hilbed.replay.recording import read_recording
from hilbed.scenario.load import load
from hilbed.types import ScenarioError
from tests.program.hilbed import hilbed

SCENARIO = """\
seed: 2
duration: 1
plant: {kind: bullet, beacons: [{at: [3.0, 0.0]}, {at: [0.0, 3.0]}]}
nodes:
  left: {table: ./drives/mine.yaml, id: 7, axis: 1}
  right: {table: drives/mine.yaml, id: 7, axis: 2}
estimator: odometry
controller: open_loop
reference: {kind: stadium, straight: 4.0, radius: 1.0, acceleration: 0.5}
"""


@pytest.fixture
def scenario(tmp_path: Path) -> Path:
    """A scenario of two axes whose table is the user's own: other units, another identity."""
    (tmp_path / "drives").mkdir()
    text = (TABLES / "zlac8015d.yaml").read_text()
    text = text.replace("name: zlac8015d", "name: mine").replace("vendor: 0x100", "vendor: 0x7A7A")
    text = text.replace("velocity: rpm ", "velocity: rpm/10 ").replace("gear: 1.0", "gear: 2.5")
    (tmp_path / "drives" / "mine.yaml").write_text(text)
    path = tmp_path / "scenario.yaml"
    path.write_text(SCENARIO)
    return path


def test_a_run_with_it_keeps_it_and_can_be_replayed_elsewhere(scenario: Path, tmp_path: Path) -> None:
    run, elsewhere = tmp_path / "run", tmp_path / "elsewhere"
    ended = hilbed("run", scenario, "--out", run)
    assert (ended.status, ended.err) == (0, "")
    shutil.move(run, elsewhere)
    shutil.rmtree(scenario.parent / "drives")
    recording = read_recording(elsewhere)
    node = recording.loaded.scenario.nodes["left"]
    table = load_table(node.table)
    assert (table.name, table.identity.vendor, table.units.gear) == ("mine", 0x7A7A, 2.5)
    assert Path(node.table).is_relative_to(elsewhere)
    assert differences(recording.signals, replay(recording).signals) == []
    measured = recording.signals["drive/left/speed_measured"]
    true = recording.signals["drive/left/speed"]
    assert abs(measured[-1] - true[-1]) < 0.05 * abs(true[-1])


def _broken(scenario: Path, old: str, new: str) -> str:
    table = scenario.parent / "drives" / "mine.yaml"
    text = table.read_text()
    assert old in text
    table.write_text(text.replace(old, new))
    with pytest.raises(ScenarioError) as told:
        read_table(table)
    with pytest.raises(ScenarioError, match=r"scenario\.yaml:5: nodes\.left\.table: .*mine\.yaml"):
        load(str(scenario))
    return str(told.value)


def _line(scenario: Path, text: str) -> int:
    lines = (scenario.parent / "drives" / "mine.yaml").read_text().splitlines()
    return next(number for number, line in enumerate(lines, start=1) if text in line)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("gear: 2.5", "gaer: 2.5", "unknown key 'gaer'; did you mean 'gear'?"),
        ("velocity: rpm/10 ", "velocity: rps ", "units.velocity: 'rps'"),
        ("index: 0x6040", "index: 0x16040", "objects.controlword.index"),
        (
            "sub: 1, type: i16, per_axis: sub",
            "sub: 1, type: i12, per_axis: sub",
            "objects.current_actual.type",
        ),
        ("modes: {pv: 3}", "modes: {pv: three}", "modes.pv"),
        ("type: u32, per_axis: half}\n  mode:", "type: u16, per_axis: half}\n  mode:", "halves of a u16"),
    ],
)
def test_what_is_wrong_is_told_with_its_line(scenario: Path, old: str, new: str, words: str) -> None:
    told = _broken(scenario, old, new)
    assert words in told
    place = new.splitlines()[0]
    assert told.startswith(f"{scenario.parent / 'drives' / 'mine.yaml'}:{_line(scenario, place)}: ")


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (
            "velocity_actual.1, velocity_actual.2",
            "velocity_actual.1",
            "no TPDO maps velocity_actual of axis 2",
        ),
        ("velocity_actual.1, velocity_actual.2", "velocity_actual", "maps 'velocity_actual'"),
        ("position_actual.2", "position_actual.3", "maps 'position_actual.3'"),
        ("map: [controlword]", "map: [controlword, mode]", "an RPDO maps mode"),
        ("map: [controlword]", "map: [mode_display]", "no RPDO maps controlword of axis 1"),
        ("polarity: [1, -1]", "polarity: [1]", "1 signs for 2 axes"),
        ("map: [error_code, mode_display]", "map: [error_code, statusword, mode_display]", "longer than 8"),
        ("  controlword: {", "  cntrlword: {", "objects has no controlword"),
    ],
)
def test_what_does_not_fit_together_is_told(scenario: Path, old: str, new: str, words: str) -> None:
    assert words in _broken(scenario, old, new)


@pytest.mark.parametrize("text", ["", "- 1", "name: [", "a: 1\na: 2", "\0"])
def test_a_file_that_is_no_table_is_told(scenario: Path, text: str) -> None:
    table = scenario.parent / "drives" / "mine.yaml"
    table.write_text(text)
    with pytest.raises(ScenarioError, match=r"mine\.yaml"):
        read_table(table)


@pytest.mark.parametrize("name", ["./drives/none.yaml", "../outside.yaml", "/etc/passwd.yaml", "drives"])
def test_a_table_that_is_not_there_is_told(scenario: Path, name: str) -> None:
    (scenario.parent.parent / "outside.yaml").write_text("name: outside")
    scenario.write_text(SCENARIO.replace("./drives/mine.yaml", name))
    ended = hilbed("check", scenario)
    assert ended.status == 4
    assert f"{scenario}:5: nodes.left.table: " in ended.err
    assert "drive table" in ended.err
    assert "Traceback" not in ended.err


def test_a_table_on_the_command_line(scenario: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(scenario.parent)
    assert named_table("drives/mine.yaml").name == "mine"
    ended = hilbed(
        "conformance", "-i", "hilbed", "--node", "7", "--drive", "drives/mine.yaml", cwd=scenario.parent
    )
    assert (ended.status, ended.err) == (0, "")
    assert "table mine" in ended.out


def test_a_changed_file_is_read_again(scenario: Path) -> None:
    import os

    table = scenario.parent / "drives" / "mine.yaml"
    assert load_table(str(table)).units.gear == 2.5
    table.write_text(table.read_text().replace("gear: 2.5", "gear: 3.0"))
    os.utime(table, ns=(1, 1))
    assert load_table(str(table)).units.gear == 3.0
