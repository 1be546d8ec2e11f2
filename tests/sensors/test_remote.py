"""The eye in a process of its own: the same to the bit, and never a hang nor an orphan."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from time import sleep
from typing import Any

import pytest
from numpy.testing import assert_array_equal

from hilbed.cost import Cost
from hilbed.effects import Effects
from hilbed.rng import stream
from hilbed.sensors.camera import Camera, CameraSpec, open_eye
from hilbed.sensors.exposure import Exposure, still
from hilbed.sensors.eye import Setting
from hilbed.sensors.remote import EyeLost, RemoteEye
from hilbed.types import Nanos, Pose, Reading, ScenarioError, Snapshot, Truth
from tests.sensors.cameras import BEACONS, ORIGIN, Notes

PERIOD: Nanos = 10_000_000
FAULTS = {"noise": 0.01, "missed": 0.2, "spurious": 0.3, "loss": 0.2, "fov_deg": 120}
STILL = still(0, ORIGIN)
TRACKING = {"kind": "tracking", "rate": 2.0}


class Diary(Notes):
    """A witness that remembers in which order it was told, and when."""

    def __init__(self) -> None:
        super().__init__()
        self.told: list[tuple[Nanos, object]] = []
        self.now: Nanos = 0

    def reading(self, reading: Reading, beacon: int, true: tuple[float, ...]) -> None:
        super().reading(reading, beacon, true)
        self.told.append((self.now, repr((reading, beacon, true))))  # NaN is like itself

    def snapshot(self, snapshot: Snapshot) -> None:
        super().snapshot(snapshot)
        self.told.append((self.now, snapshot._replace(image=None)))  # type: ignore[arg-type]


def drive(block: dict[str, Any], separate: bool, periods: int = 150) -> tuple[Diary, list[object]]:
    """Turns a robot for a while, blind and dazzled in turn, and returns what witness and controller heard."""
    spec, cost, effects, diary = CameraSpec.model_validate(block), Cost(), Effects([1.0]), Diary()
    camera = Camera(
        spec, open_eye(spec, Setting(BEACONS), cost, separate), stream(1, "camera"), effects, diary
    )
    heard: list[object] = []
    for k in range(periods):
        diary.now = k * PERIOD
        effects.blind = 60 <= k < 85
        effects.spurious = 1.0 if 100 <= k < 120 else 0.0
        if camera.due <= diary.now:
            camera.sample(Truth(diary.now, Pose(0.002 * k, 0.1, 0.03 * k)))
        heard.append(camera.read(diary.now))
    camera.flush()
    heard.append(camera.read(100 * periods * PERIOD))
    camera.close()
    assert cost.render > 0.0
    assert cost.vision > 0.0
    return diary, heard


@contextmanager
def eye() -> Iterator[RemoteEye]:
    remote = RemoteEye(CameraSpec(), Setting(BEACONS), Cost())
    try:
        yield remote
    finally:
        remote.close()


def alive(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


def ends(pid: int) -> bool:
    for _ in range(400):
        if not alive(pid):
            return True
        sleep(0.05)
    return False


@pytest.mark.parametrize(
    "block",
    [
        {**FAULTS, "pan": {"kind": "scanning", "rate": 3.0}, "ground": True},
        {**FAULTS, "pan": TRACKING, "identity": "anonymous"},
        {"pan": TRACKING, "latency": 0.0, "mount": [0.2, 0.1, 0.3]},
        {**FAULTS, "pan": TRACKING, "latency": 0.35},
        {**FAULTS, "rate": 200.0, "latency": 0.003, "height": 16},
        {
            "exposure": 0.003,
            "readout": 0.001,
            "read_noise": 0.03,
            "k1": -0.02,
            "tilt_deg": 3.0,
            "fov_deg": 120,
        },
    ],
)
def test_both_ways_tell_the_same_at_the_same_time(block: dict[str, Any]) -> None:
    here, heard_here = drive(block, separate=False)
    there, heard_there = drive(block, separate=True)
    assert len(here.readings) > 10
    assert here.told == there.told
    assert heard_here == heard_there
    for one, other in zip(here.snapshots, there.snapshots, strict=True):
        assert_array_equal(one.image, other.image)


def test_a_frame_is_asked_for_when_it_is_delivered_or_when_the_next_is_exposed() -> None:
    diary, _ = drive({"latency": 0.05}, separate=False, periods=30)
    assert [now for now, entry in diary.told if isinstance(entry, Snapshot)] == [5e7, 15e7, 25e7]
    diary, _ = drive({"latency": 0.25}, separate=False, periods=30)
    assert [now for now, entry in diary.told if isinstance(entry, Snapshot)] == [10e7, 20e7, 29e7]


def test_images_are_not_written_to_by_the_next_frame() -> None:
    with eye() as remote:
        first = remote.look(STILL)().image
        kept = first.copy()
        second = remote.look(still(0, ORIGIN, 1.0))().image
    assert_array_equal(first, kept)
    assert (first != second).any()


def test_a_second_look_before_the_first_was_taken_is_refused() -> None:
    with eye() as remote:
        ticket = remote.look(STILL)
        with pytest.raises(RuntimeError):
            remote.look(STILL)
        assert ticket().findings


def test_no_child_is_left_after_close_nor_when_the_eye_is_forgotten() -> None:
    with eye() as remote:
        assert alive(remote.pid)
    assert not alive(remote.pid)
    remote = RemoteEye(CameraSpec(), Setting(BEACONS), Cost())
    pid = remote.pid
    assert alive(pid)
    del remote
    assert not alive(pid)


@pytest.mark.parametrize("frames", [0, 1])
def test_a_child_that_is_killed_before_or_between_frames_is_an_error(frames: int) -> None:
    with eye() as remote:
        for _ in range(frames):
            remote.look(STILL)()
        os.kill(remote.pid, signal.SIGKILL)
        for _ in range(2):
            with pytest.raises(EyeLost, match="ended with -9"):
                remote.look(STILL)()
            remote._asked = False


def test_a_child_that_is_killed_while_a_frame_is_under_way_is_an_error() -> None:
    with eye() as remote:
        remote.look(STILL)()
        os.kill(remote.pid, signal.SIGSTOP)
        ticket = remote.look(STILL)
        os.kill(remote.pid, signal.SIGKILL)
        with pytest.raises(EyeLost, match="ended with -9"):
            ticket()


@pytest.mark.parametrize("met", [False, True])
def test_a_child_that_hangs_is_an_error_and_ended(met: bool) -> None:
    with eye() as remote:
        if met:
            remote.look(STILL)()
        os.kill(remote.pid, signal.SIGSTOP)
        remote._socket.settimeout(0.2)
        with pytest.raises(EyeLost, match=r"has not answered for 0\.2 s"):
            remote.look(STILL)()
        assert not alive(remote.pid)


def test_what_goes_wrong_in_the_child_is_told() -> None:
    with eye() as remote:
        ticket = remote.look(Exposure(0, ()))
        with pytest.raises(EyeLost, match="IndexError"):
            ticket()
        assert not alive(remote.pid)


def test_an_egl_that_does_not_work_is_an_error_of_the_scenario(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere")
    monkeypatch.setenv("__EGL_VENDOR_LIBRARY_DIRS", "/nowhere")
    with pytest.raises(ScenarioError, match="egl does not work here"):
        RemoteEye(CameraSpec(renderer="egl"), Setting(BEACONS), Cost())


def test_a_process_that_cannot_be_started_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "executable", "/nowhere/python")
    with pytest.raises(EyeLost, match="No such file"):
        RemoteEye(CameraSpec(), Setting(BEACONS), Cost())


def test_an_interrupt_does_not_reach_the_child() -> None:
    with eye() as remote:
        remote.look(STILL)()
        os.kill(remote.pid, signal.SIGINT)
        assert remote.look(STILL)().findings
        assert os.getpgid(remote.pid) != os.getpgid(0)


def test_the_child_leaves_the_processor_of_the_bench_where_there_is_another() -> None:
    ours = os.sched_getaffinity(0)
    with eye() as remote:
        remote.look(STILL)()
        theirs = os.sched_getaffinity(remote.pid)
    assert theirs <= ours
    assert len(theirs) == max(1, len(ours) - 1)
    assert os.sched_getaffinity(0) == ours


SCRIPT = """
import sys
from hilbed.cost import Cost
from hilbed.sensors.camera import CameraSpec, open_eye
from hilbed.scene import BeaconSpec
from hilbed.sensors.exposure import still
from hilbed.sensors.eye import Setting
from hilbed.types import Pose
eye = open_eye(CameraSpec(), Setting((BeaconSpec(at=(4.0, 0.0)),)), Cost(), separate=True)
assert eye.look(still(0, Pose(0.0, 0.0, 0.0)))().findings
print(eye.pid, flush=True)
sys.stdin.buffer.raw.read() if len(sys.argv) > 1 else None
"""


def test_a_script_without_a_main_guard_and_silence_on_both_outputs() -> None:
    done = subprocess.run([sys.executable, "-"], input=SCRIPT, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    assert not alive(int(done.stdout))


def test_no_orphan_when_the_bench_is_killed() -> None:
    bench = subprocess.Popen(
        [sys.executable, "-c", SCRIPT, "wait"], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    assert bench.stdout is not None
    child = int(bench.stdout.readline())
    assert alive(child)
    bench.kill()
    bench.communicate()
    assert ends(child)
