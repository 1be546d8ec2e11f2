"""`hilbed run` with somebody else's detector: whose code is run, what it costs, what the verdict says."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from hilbed.clock import SECOND
from hilbed.record.folder import RunFolder
from hilbed.report import write_report
from hilbed.runner import Outcome, perform
from hilbed.scenario.load import load
from hilbed.sensors.troubles import KEPT, Troubles
from hilbed.types import ScenarioError
from hilbed.vision.detectors import ForeignSpec
from tests.program.hilbed import hilbed
from tests.vision.foreign import write

SHORT = ("duration=1", "criteria={}", "record=signals")
SETTINGS = [word for setting in SHORT for word in ("--set", setting)]
SCENARIO = """
duration: 0.5
plant: {kind: kinematic, beacons: [{at: [4.0, 0.5], colour: red}, {at: [4.0, -0.5], colour: blue}]}
sensors: {camera: {kind: camera, detector: DETECTOR}}
estimator: ekf
controller: open_loop
reference: {kind: line, length: 10, speed: 0.1}
record: signals
"""


@pytest.fixture
def code(tmp_path: Path) -> Path:
    return write(tmp_path)


def scenario(folder: Path, detector: str) -> Path:
    file = folder / "own.yaml"
    file.write_text(SCENARIO.replace("DETECTOR", detector))
    return file


def outcome(name: str | Path, detector: str | None = None, separate: bool = False) -> Outcome:
    settings = SHORT if name == "demo" else ()
    return perform(load(str(name), settings, None, detector), None, separate=separate)


def counted(outcome: Outcome) -> dict[str, float]:
    counts: dict[str, float] = outcome.verdict["counts"]["sensors.camera"]
    return {name: count for name, count in counts.items() if count}


@pytest.mark.parametrize("name", ["Fixed", "Raises", "Returns"])
def test_in_the_bench_s_process_and_in_another_the_run_is_the_same(
    tmp_path: Path, code: Path, name: str
) -> None:
    block = f"{{kind: foreign, code: '{code.name}:{name}', options: OPTIONS}}"
    options = {"Fixed": "{azimuth: 0.12, column: 280.0, beacon: 0}", "Returns": "{what: '[(9.0, 1.0, 3.0)]'}"}
    file = scenario(tmp_path, block.replace("OPTIONS", options.get(name, "{}")))
    here, there = outcome(file), outcome(file, separate=True)
    assert here.verdict["hash"] == there.verdict["hash"]
    assert counted(here) == counted(there)
    assert here.verdict["detectors"] == there.verdict["detectors"]
    assert here.verdict["reproducible"] is True


def test_one_that_raises_costs_its_frames_and_is_told(code: Path) -> None:
    ended = outcome("demo", f"{code}:Raises")
    assert ended.status == 0
    frames = counted(ended)["frames"]
    assert frames >= 11
    assert counted(ended) == {"frames": frames, "raised": frames}
    (line,) = ended.verdict["detectors"]["camera"]
    assert line.startswith(f"raised {frames:g} of {frames:g} frames, first at t = 0.000 s: ")
    assert "eyes.py:" in line
    assert "ZeroDivisionError" in line
    assert line.endswith("\n  | about to divide")
    assert len(ended.verdict["hash"]) == 64


@pytest.mark.parametrize("separate", [False, True])
def test_a_missed_deadline_makes_a_run_one_that_cannot_be_repeated(
    tmp_path: Path, code: Path, separate: bool
) -> None:
    file = scenario(tmp_path, f"{{kind: foreign, code: '{code.name}:Hangs', deadline: 0.3}}")
    ended = outcome(file, separate=separate)
    assert counted(ended) == {"frames": 5, "late": 2}
    assert ended.verdict["reproducible"] is False
    assert len(ended.verdict["hash"]) == 64
    assert "missed its deadline of 0.3 s at" in ended.verdict["detectors"]["camera"][0]


def test_built_in_detectors_have_nothing_to_count() -> None:
    ended = outcome("demo")
    assert "sensors.camera" not in ended.verdict["counts"]
    assert "detectors" not in ended.verdict
    assert ended.verdict["reproducible"] is True


@pytest.mark.parametrize("separate", [False, True])
@pytest.mark.parametrize("name", ["Broken", "Blind", "Absent"])
def test_code_that_cannot_be_used_is_found_before_the_run(code: Path, name: str, separate: bool) -> None:
    with pytest.raises(ScenarioError, match=rf"detector .*eyes\.py:{name}: "):
        outcome("demo", f"{code}:{name}", separate)


def test_a_word_is_short_for_code_and_a_block_can_be_set_key_by_key(code: Path, tmp_path: Path) -> None:
    file = scenario(tmp_path, f"{code.name}:Fixed")
    settings = ["sensors.camera.detector.deadline=0.5", "sensors.camera.detector.options.azimuth=0.25"]
    detector = load(str(file), settings).scenario.sensors["camera"].detector  # type: ignore[union-attr]
    assert detector.model_dump() == {
        "kind": "foreign", "code": f"{code}:Fixed", "deadline": 0.5, "startup": 60.0,
        "options": {"azimuth": 0.25},
    }  # fmt: skip


@pytest.mark.parametrize(
    ("detector", "words"),
    [
        ("color", "did you mean 'colour'"),
        ("eyes.py:1", "does not name a class"),
        ("a-b:Eye", "does not name a module"),
        ("nowhere.py", "there is no file nowhere.py"),
        ("../outside.py", "leaves .*a detector from elsewhere is given by --detector"),
        ("nowhere_at_all:Eye", "no module nowhere_at_all is installed"),
        ("{kind: foreign, code: 'eyes.py', deadline: 0}", "greater than 0"),
        ("{kind: foreign}", "code is missing"),
        ("{kind: foreign, code: 'eyes.py', dedline: 1}", "did you mean 'deadline'"),
        ("{kind: markers, dictionary: 4X4_51}", "4X4_5"),
    ],
)
def test_a_detector_that_cannot_be_is_told_with_its_line(tmp_path: Path, detector: str, words: str) -> None:
    inner = tmp_path / "inner"
    inner.mkdir()
    (tmp_path / "outside.py").write_text("")
    write(inner)
    with pytest.raises(ScenarioError, match=rf"own\.yaml:4: .*{words}"):
        load(str(scenario(inner, detector)))


def test_a_symbolic_link_out_of_the_folder_is_no_way_out(tmp_path: Path, code: Path) -> None:
    inner = tmp_path / "inner"
    inner.mkdir()
    (inner / "eyes.py").symlink_to(code)
    with pytest.raises(ScenarioError, match="leaves"):
        load(str(scenario(inner, "eyes.py:Fixed")))


@pytest.mark.parametrize(
    ("detector", "words"),
    [("nowhere.py", "there is no file"), ("color", "neither a kind"), ("nowhere_at_all:Eye", "is installed")],
)
def test_what_is_wrong_on_the_command_line_is_told_as_such(detector: str, words: str) -> None:
    with pytest.raises(ScenarioError, match=f"^--detector {detector}: .*{words}"):
        load("demo", (), None, detector)
    with pytest.raises(ScenarioError, match="has no camera"):
        load("bui2022/open-loop", (), None, "colour")


def test_check_does_not_run_the_code(tmp_path: Path) -> None:
    (tmp_path / "eyes.py").write_text(f"open({str(tmp_path / 'trace')!r}, 'w')\n")
    assert hilbed("check", scenario(tmp_path, "eyes.py")).status == 0
    assert not (tmp_path / "trace").exists()


def test_a_run_keeps_the_code_and_runs_again_elsewhere(tmp_path: Path, code: Path) -> None:
    folder, again = tmp_path / "run", tmp_path / "again"
    first = hilbed("run", "demo", *SETTINGS, "--detector", "eyes.py:Raises", "--out", folder, cwd=code.parent)
    assert first.status == 0, first.err
    assert "detector of camera: raised 12 of 12 frames" in first.out
    assert (folder / "files" / "eyes.py").read_bytes() == code.read_bytes()
    code.unlink()
    second = hilbed("run", folder.rename(tmp_path / "moved") / "scenario.yaml", "--out", again)
    assert second.status == 0, second.err
    assert verdict(again)["hash"] == verdict(tmp_path / "moved")["hash"]


CHATTERS = """
class Chatters:
    shown = 0

    def detect(self, shot):
        self.shown += 1
        print("frame", self.shown)
        if self.shown == 3:
            raise ValueError("three")
        return []
"""


@pytest.mark.parametrize("separate", [False, True])
def test_what_it_prints_is_kept_beside_the_run(tmp_path: Path, separate: bool) -> None:
    (tmp_path / "chatters.py").write_text(CHATTERS)
    loaded = load("demo", SHORT, detector=str(tmp_path / "chatters.py"))
    folder = tmp_path / "run"
    perform(loaded, RunFolder(folder), separate=separate)
    frames = verdict(folder)["counts"]["sensors.camera"]["frames"]
    told = "".join(f"t = {0.1 * k:.3f} s\nframe {k + 1}\n" for k in range(int(frames)))
    assert frames > 3
    assert (folder / "detectors" / "camera.log").read_text() == told
    assert '<a href="detectors/camera.log">' in write_report(folder).read_text()
    perform(load("demo", SHORT), RunFolder(folder, force=True))
    assert not (folder / "detectors").exists()


def test_of_a_detector_that_never_stops_talking_the_last_is_kept() -> None:
    troubles = Troubles(ForeignSpec(code="eyes.py"))
    for k in range(40):
        troubles.hear(k * SECOND, f"{k} " + "x" * 60_000)
    assert len(troubles.heard) <= KEPT
    assert troubles.heard.startswith("t = 23.000 s\n23 x")
    assert troubles.heard.endswith("x\n")
    assert "t = 39.000 s" in troubles.heard


def verdict(folder: Path) -> dict[str, Any]:
    content: dict[str, Any] = json.loads((folder / "verdict.json").read_text())
    return content


def test_exit_status_and_message_of_code_that_cannot_be_used(code: Path, tmp_path: Path) -> None:
    ended = hilbed("run", "demo", *SETTINGS, "--detector", f"{code}:Broken", "--out", tmp_path / "run")
    assert ended.status == 4
    assert "Traceback" not in ended.err
    assert "RuntimeError: no weights" in ended.err
    assert not (tmp_path / "run").exists()
