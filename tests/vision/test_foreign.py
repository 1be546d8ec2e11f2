"""Foreign detectors in their own process: what they do wrong costs a frame, and says where."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from re import fullmatch
from time import sleep
from typing import Any

import numpy as np
import pytest

from hilbed.types import ScenarioError
from hilbed.vision import foreign
from hilbed.vision.detectors import ForeignSpec
from hilbed.vision.foreign import ForeignDetector
from hilbed.vision.seams import Detection, DetectionFailed, Shot, Trouble
from tests.vision.foreign import line, write
from tests.vision.scenes import WIDE

Make = Callable[..., ForeignDetector]


def shot(t: int = 0, value: int = 0) -> Shot:
    return Shot(np.full((64, 640, 3), value, np.uint8), t, WIDE)


@pytest.fixture
def code(tmp_path: Path) -> Path:
    return write(tmp_path)


@pytest.fixture
def make(code: Path) -> Iterator[Make]:
    made: list[ForeignDetector] = []

    def one(name: str, beacons: int = 4, anonymous: bool = False, **block: Any) -> ForeignDetector:
        spec = ForeignSpec(code=f"{code}:{name}", **block)
        made.append(ForeignDetector(spec, WIDE, beacons, anonymous))
        return made[-1]

    yield one
    for detector in made:
        detector.close()


def trouble(detector: ForeignDetector) -> Trouble:
    with pytest.raises(DetectionFailed) as failed:
        detector.detect(shot())
    return failed.value.trouble


def state(pid: int) -> str:
    """Returns a process's state as the kernel says it, empty where there is none."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except FileNotFoundError:
        return ""


def ends(pid: int) -> bool:
    """Tells whether a process ends soon; one that has lost its parent may wait for init to bury it."""
    for _ in range(200):
        if state(pid) in ("", "Z"):
            return True
        sleep(0.05)
    return False


def test_it_sees_the_image_its_time_and_the_lens(make: Make) -> None:
    detector = make("Looks")
    assert detector.detect(shot(t=5_000, value=77)) == [
        Detection(WIDE.azimuth(77), pytest.approx(5e-6), 77.0, None, 7.0)
    ]
    assert detector.detect(shot(t=6_000, value=200))[0].column == 200.0


def test_it_is_made_with_its_options(make: Make) -> None:
    (found,) = make("Fixed", options={"azimuth": -0.3, "column": 417.0, "beacon": 3}).detect(shot())
    assert found[:4] == (-0.3, 1e-3, 417.0, 3)


def test_an_anonymous_camera_takes_identities_out(make: Make) -> None:
    assert make("Fixed", anonymous=True).detect(shot())[0].beacon is None


@pytest.mark.parametrize(
    ("name", "failure", "words"),
    [
        ("Raises", "raised", ["eyes.py:{}", "in detect", "ZeroDivisionError"]),
        ("Exits", "raised", ["eyes.py", "SystemExit: enough"]),
        ("Dies", "died", ["ended with 7"]),
        ("Crashes", "died", ["SIGSEGV", "eyes.py", "in detect"]),
        ("Garbage", "died", ["garbage"]),
    ],
)
def test_what_goes_wrong_is_told_with_its_place(
    make: Make, name: str, failure: str, words: list[str]
) -> None:
    told = trouble(make(name))
    assert told.failure == failure
    for word in words:
        assert word.format(line("return 1 / 0")) in told.text


def test_what_it_printed_goes_with_the_failure(make: Make) -> None:
    assert trouble(make("Raises")).said == "about to divide\n"
    assert trouble(make("Dies")).said == "last words"


def test_one_that_raises_keeps_its_process_and_its_state(make: Make) -> None:
    detector = make("Raises")
    pid = detector.pid
    for _ in range(3):
        assert trouble(detector).failure == "raised"
    assert detector.pid == pid


def test_one_that_hangs_misses_its_deadline_and_is_started_again(make: Make) -> None:
    detector = make("Hangs", deadline=0.3)
    assert len(detector.detect(shot())) == 1
    pid = detector.pid
    assert pid is not None
    told = trouble(detector)
    assert told.failure == "late"
    assert fullmatch(r"missed its deadline of 0\.3 s at \S+/eyes\.py:\d+ in detect", told.text)
    assert state(pid) == ""
    assert len(detector.detect(shot())) == 1
    assert detector.pid != pid


def test_one_that_sleeps_says_what_it_had_printed(make: Make) -> None:
    assert trouble(make("Sleeps", deadline=0.5)).said == "good night\n"


def test_one_that_is_lost_again_and_again_is_not_asked_any_more(make: Make) -> None:
    detector = make("Dies")
    failures = [trouble(detector).failure for _ in range(foreign.RESTARTS + 3)]
    assert failures == ["died"] * (foreign.RESTARTS + 1) + ["skipped"] * 2
    assert detector.pid is None


def test_one_that_hangs_now_and_then_is_not_waited_for_for_ever(
    make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(foreign, "MOST_RESTARTS", 1)
    detector = make("Hangs", deadline=0.2)
    failures = []
    for _ in range(6):
        try:
            detector.detect(shot())
        except DetectionFailed as failed:
            failures.append(failed.failure)
    assert failures == ["late", "late", "skipped", "skipped"]


def test_a_million_characters_neither_block_it_nor_stay(make: Make) -> None:
    detector = make("Chatters")
    for _ in range(3):
        assert detector.detect(shot()) == []


@pytest.mark.parametrize(
    ("what", "words"),
    [
        ("None", "not a list"),
        ("'abc'", "not a list"),
        ("iter([])", "not a list"),
        ("[(0.1, 1e-3, 3.0)] * 1001", "1001 detections, more than 1000"),
        ("[5]", "no detection"),
        ("[(0.1, 1e-3)]", "no column"),
        ("[{'azimuth': 0.1, 'std': 1e-3, 'column': 3.0, 'beakon': 1}]", "did you mean 'beacon'"),
        ("[('0.1', 1e-3, 3.0)]", "azimuth is '0.1', not a number"),
        ("[(0.1, 1e-3, 3.0, 1.5)]", "beacon is 1.5, not an index"),
        ("[(float('nan'), 1e-3, 3.0)]", "not finite"),
        ("[(0.1, float('inf'), 3.0)]", "not finite"),
        ("[(0.1, -1e-3, 3.0)]", "std is -0.001"),
        ("[(0.1, 0.0, 3.0)]", "std is 0"),
        ("[(1.5, 1e-3, 3.0)]", "azimuth is 1.5 rad, out of the image"),
        ("[(0.1, 1e-3, 640.0)]", "column is 640, out of the image"),
        ("[(0.1, 1e-3, 3.0, None, -2.0)]", "row is -2, out of the image"),
        ("[(0.1, 1e-3, 3.0, 4)]", "beacon is 4, but there are 4"),
        ("[(0.1, 1e-3, 3.0, -1)]", "beacon is -1"),
        ("[(10 ** 400, 1e-3, 3.0)]", "not a number"),
        ("[type('Odd', (), {'__repr__': lambda self: 1 / 0})()]", "no detection"),
    ],
)
def test_an_answer_that_is_none_is_invalid(make: Make, what: str, words: str) -> None:
    told = trouble(make("Returns", options={"what": what}))
    assert told.failure == "invalid"
    assert words in told.text


@pytest.mark.parametrize(
    "what",
    [
        "[Detection(0.1, 1e-3, 300.0, 2, 9.0)]",
        "[(0.1, 1e-3, 300.0, 2, 9.0)]",
        "[[0.1, 1e-3, 300.0, 2, 9.0]]",
        "({'azimuth': 0.1, 'std': 1e-3, 'column': 300, 'row': 9, 'beacon': 2},)",
        "[(np.float64(0.1), np.float64(1e-3), np.float32(300.0), np.int64(2), np.uint8(9))]",
    ],
)
def test_an_answer_may_be_written_in_several_ways(make: Make, what: str) -> None:
    imports = "exec('import numpy as np; from hilbed.vision.seams import Detection', globals()) or "
    (found,) = make("Returns", options={"what": imports + what}).detect(shot())
    assert found == Detection(0.1, 1e-3, 300.0, 2, 9.0)


def test_detections_are_ordered_from_left_to_right(make: Make) -> None:
    found = make("Returns", options={"what": "[(0.0, 1e-3, 320.0), (0.5, 1e-3, 20.0)]"}).detect(shot())
    assert [one.column for one in found] == [20.0, 320.0]


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("Fixt", "did you mean Fixed"),
        ("Blind", "has no method detect"),
        ("number", "is not a class"),
        ("Broken", "RuntimeError: no weights"),
        ("Returns", "missing 1 required positional argument"),
    ],
)
def test_code_that_cannot_be_used_is_refused(make: Make, name: str, words: str) -> None:
    with pytest.raises(ScenarioError, match=words):
        make(name)


def test_a_constructor_that_never_ends_is_refused(make: Make) -> None:
    with pytest.raises(
        ScenarioError, match=r"not made within its startup of 1 s at .*eyes\.py:\d+ in __init__"
    ):
        make("Slow", startup=1.0)


def test_an_error_of_syntax_is_refused_with_its_line(tmp_path: Path) -> None:
    file = tmp_path / "odd.py"
    file.write_text("import os\ndef x(:\n")
    with pytest.raises(ScenarioError, match=r"odd\.py:2: SyntaxError"):
        ForeignDetector(ForeignSpec(code=str(file)), WIDE, 1)


def test_a_file_with_one_detector_needs_no_name_but_one_with_several_does(code: Path, tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match=r"several detectors \(Fixed, Looks"):
        ForeignDetector(ForeignSpec(code=str(code)), WIDE, 1)
    single = tmp_path / "single.py"
    single.write_text("from eyes import Fixed as _\nclass One:\n    def detect(self, shot): return []\n")
    detector = ForeignDetector(ForeignSpec(code=str(single)), WIDE, 1)
    assert detector.detect(shot()) == []
    detector.close()


def test_no_class_is_made_that_does_not_detect(tmp_path: Path) -> None:
    """An installed class with side effects, named by a scenario that somebody else has written."""
    trace = tmp_path / "trace"
    spec = ForeignSpec(code="subprocess:Popen", options={"args": ["touch", str(trace)]})
    with pytest.raises(ScenarioError, match="no method detect"):
        ForeignDetector(spec, WIDE, 1)
    sleep(0.2)
    assert not trace.exists()


def test_a_module_that_is_not_installed_is_refused() -> None:
    with pytest.raises(
        ScenarioError, match="no module nowhere_at_all is installed; a file is given by its path"
    ):
        ForeignDetector(ForeignSpec(code="nowhere_at_all.eyes:Eye"), WIDE, 1)


def test_a_process_that_cannot_be_started_is_told(code: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "executable", "/nowhere/python")
    with pytest.raises(ScenarioError, match="No such file"):
        ForeignDetector(ForeignSpec(code=f"{code}:Fixed"), WIDE, 1)


def test_no_child_is_left_after_close_nor_when_it_is_forgotten(make: Make, code: Path) -> None:
    detector = make("Fixed")
    pid = detector.pid
    assert pid is not None
    detector.close()
    assert state(pid) == ""
    forgotten = ForeignDetector(ForeignSpec(code=f"{code}:Fixed"), WIDE, 2)
    pid = forgotten.pid
    assert pid is not None
    assert state(pid) not in ("", "Z")
    del forgotten
    assert state(pid) == ""


def test_what_it_has_started_ends_with_it(tmp_path: Path) -> None:
    file, told = tmp_path / "parent.py", tmp_path / "pid"
    file.write_text(
        "import subprocess\nclass Parent:\n    def __init__(self):\n"
        "        child = subprocess.Popen(['sleep', '1000'])\n"
        f"        open({str(told)!r}, 'w').write(str(child.pid))\n"
        "    def detect(self, shot): return []\n"
    )
    detector = ForeignDetector(ForeignSpec(code=str(file)), WIDE, 1)
    pid = int(told.read_text())
    assert state(pid) not in ("", "Z")
    detector.close()
    assert ends(pid)


SCRIPT = """
import sys, os
from hilbed.cost import Cost
from hilbed.scene import BeaconSpec
from hilbed.sensors.camera import CameraSpec, open_eye
from hilbed.sensors.exposure import still
from hilbed.sensors.eye import Setting
from hilbed.types import Pose
block = {"kind": "foreign", "code": sys.argv[1] + ":Hangs", "deadline": 60.0}
separate = sys.argv[2] == "separate"
setting = Setting((BeaconSpec(at=(4.0, 0.0)),))
eye = open_eye(CameraSpec(detector=block), setting, Cost(), separate=separate)
pose = Pose(0.0, 0.0, 0.0)
eye.look(still(0, pose, 0.0))()
print(os.getpid(), flush=True)
eye.look(still(1, pose, 0.0))()
"""


def children(pid: int) -> list[int]:
    """Returns a process's children and theirs."""
    try:
        own = [int(one) for one in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]
    except FileNotFoundError:
        return []
    return own + [inner for child in own for inner in children(child)]


@contextmanager
def hanging(code: Path, how: str) -> Iterator[tuple[subprocess.Popen[bytes], list[int]]]:
    """Yields a bench whose detector hangs, and all its children."""
    bench = subprocess.Popen([sys.executable, "-c", SCRIPT, str(code), how], stdout=subprocess.PIPE)
    try:
        assert bench.stdout is not None
        assert int(bench.stdout.readline()) == bench.pid
        yield bench, children(bench.pid)
    finally:
        bench.kill()
        bench.communicate()


@pytest.mark.parametrize(("how", "count"), [("here", 1), ("separate", 2)])
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_no_orphan_when_the_bench_is_killed_while_its_detector_hangs(
    code: Path, how: str, count: int, number: signal.Signals
) -> None:
    with hanging(code, how) as (bench, processes):
        assert len(processes) == count
        os.kill(bench.pid, number)
        bench.wait()
        assert all(map(ends, processes))


def test_the_class_of_the_readme_is_a_detector(tmp_path: Path) -> None:
    readme = (Path(__file__).parents[2] / "README.md").read_text()
    begin = readme.index("class Mine:")
    file = tmp_path / "mine.py"
    file.write_text(readme[begin : readme.index("```", begin)])
    detector = ForeignDetector(ForeignSpec(code=str(file), options={"threshold": 0.5}), WIDE, 3)
    (found,) = detector.detect(shot())
    assert found.azimuth == pytest.approx(WIDE.azimuth(312.4))
    assert found[1:4] == (1e-3, 312.4, 2)
    detector.close()
