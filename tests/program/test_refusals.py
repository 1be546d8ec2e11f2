"""What is wrong is told with file and line, all at once, with status 4 and nothing written."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.program.hilbed import hilbed

GOOD = """\
# A line
duration: 2
period: 0.01
plant:
  kind: bullet
  beacons:
    - {at: [3, 1]}
sensors:
  camera: {kind: camera}
estimator: ekf
controller: lqr
reference: {kind: line, length: 4}
"""


def wrong(tmp_path: Path, text: str) -> list[str]:
    """Returns what is said about a scenario that must be refused."""
    file = tmp_path / "mine.yaml"
    file.write_text(text)
    ended = hilbed("run", file, "--out", tmp_path / "run")
    assert ended.status == 4, ended.err
    assert ended.out == ""
    assert not (tmp_path / "run").exists()
    assert "Traceback" not in ended.err
    return [line.replace(str(file), "mine.yaml") for line in ended.err.splitlines()]


def test_the_good_one_is_good(tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text(GOOD)
    assert hilbed("check", tmp_path / "mine.yaml").status == 0


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("duration", "duratoin", "mine.yaml:2: unknown key 'duratoin'; did you mean 'duration'?"),
        ("duration: 2\n", "", "mine.yaml:1: duration is missing"),
        ("duration: 2", "duration: two", "mine.yaml:2: duration: input should be a valid number"),
        ("duration: 2", "duration: -2", "mine.yaml:2: duration: input should be greater than 0, given -2"),
        ("duration: 2", "duration: 2.005", "mine.yaml:2: duration: 2.005 s is not a multiple of the period"),
        (
            "period: 0.01",
            "period: 0.0105",
            "mine.yaml:3: period: 0.0105 s is not a multiple of the plant's tick",
        ),
        ("period: 0.01", "period: 0.001", "mine.yaml:"),
        (
            "kind: bullet",
            "kind: mujoco",
            "mine.yaml:5: plant: unknown kind 'mujoco'; known: bullet, kinematic, recorded",
        ),
        (
            "{at: [3, 1]}",
            "{at: [30, 1]}",
            "mine.yaml:7: plant.beacons.0.at: (30.0, 1.0) is outside the world",
        ),
        ("length: 4", "length: 40", "mine.yaml:12: reference: the path reaches x 0 … 40"),
        (
            "{kind: camera}",
            "{kind: camera, fov_deg: 200}",
            "mine.yaml:9: sensors.camera.fov_deg: input should be",
        ),
        (
            "estimator: ekf",
            "estimator: ukf",
            "mine.yaml:10: estimator: unknown kind 'ukf'; did you mean 'ekf'?",
        ),
        ("sensors:\n  camera: {kind: camera}\n", "", "mine.yaml:8: estimator: ekf needs readings"),
        ("controller: lqr\n", "", "controller is missing"),
        ("reference: {kind: line, length: 4}\n", "", "reference is missing"),
        ("estimator", "criteria: {croos_track_rms: {max: 1}}\nestimator", "did you mean 'cross_track_rms'?"),
        ("estimator", "criteria: {cross_track_rms: {}}\nestimator", "needs exactly one of max and min"),
        (
            "estimator",
            "robot: {kind: diffdrive, urdf: nowhere.urdf}\nestimator",
            "there is no file nowhere.urdf",
        ),
        ("estimator", "robot: {kind: diffdrive, urdf: ../../etc/passwd}\nestimator", "leaves"),
        ("estimator", "nodes: {left: guessed}\nestimator", "nodes.left.kind: "),
        (
            "estimator",
            "nodes: {left: real}\ndisturbances: [{kind: load_torque, drive: left, size: 1}]\nestimator",
            "mine.yaml:11: disturbances.0.drive: left is real",
        ),
        ("estimator", "nodes: {front: simulated}\nestimator", "the robot has no drive 'front'"),
        ("estimator", "bus: {kind: socketcan}\nestimator", "bus.kind: 'socketcan'"),
        ("estimator", "bus: {bitrate: 123}\nestimator", "no bit rate of CiA"),
        ("estimator", "bus: {bitrate: 50000}\nestimator", "of a bus of 50000 bit/s"),
        (
            "estimator",
            "disturbances: [{kind: load_torque, drive: middle, size: 1}]\nestimator",
            "mine.yaml:10: disturbances.0.drive: the robot has no drive 'middle'",
        ),
        ("period: 0.01", "period: 1.0e-12", "mine.yaml:3: period: 1e-12 s is less than a nanosecond"),
        ("duration: 2", "duration: '2'", "mine.yaml:2: duration: input should be a valid number, given '2'"),
        (
            "duration: 2",
            "duration: true",
            "mine.yaml:2: duration: input should be a valid number, given True",
        ),
        (
            "kind: bullet",
            "kind: bullet\n  tick: 0.002",
            "mine.yaml:6: plant.tick: 0.002 s; the drives' firmware",
        ),
        (
            "kind: bullet",
            "kind: bullet\n  chopper: {kind: switched, frequency: 1500}",
            "mine.yaml:6: plant.chopper: PWM frequency 1500 Hz is not a multiple of the tick's 1000 Hz",
        ),
        (
            "kind: bullet",
            "kind: bullet\n  chopper: {kind: switched, dead_time: 0.001}",
            "mine.yaml:6: plant.chopper: dead_time 0.001 s",
        ),
        (
            "{kind: camera}",
            "{kind: camera, pan: {kind: tracking, beacon: 7}}",
            "mine.yaml:9: sensors.camera.pan: the camera's pan axis is to follow beacon 7",
        ),
        (
            "{kind: camera}",
            "{kind: camera}\n  rear: {kind: camera, mount: [-0.1, 0, 0.3]}",
            "mine.yaml:8: sensors: camera and rear have different mounts",
        ),
        (
            "length: 4",
            "length: 4, speed: 1.0e+30",
            "mine.yaml:12: reference.speed: input should be less than",
        ),
        ("ekf", "{kind: ekf, initial_std: [0, 1, 1]}", "mine.yaml:10: estimator.initial_std.0: input should"),
        (
            "kind: bullet",
            "kind: bullet\n  encoder: {latency: 1.0e+6}",
            "mine.yaml:6: plant.encoder.latency: input should be less than or equal to 1",
        ),
        (
            "estimator",
            "disturbances: [{kind: spurious_azimuths, size: 1.0e+6}]\nestimator",
            "mine.yaml:10: disturbances.0.size: input should be less than or equal to 1000",
        ),
        ("lqr", "{kind: lqr, error: [1.0e+300, 1, 1]}", "mine.yaml:11: controller.error.0: input should be"),
        (
            "estimator",
            "criteria: {duty_max: {max: 1, drive: middle}}\nestimator",
            "mine.yaml:10: criteria.duty_max.drive: the robot has no drive 'middle'",
        ),
        ("# A line", "a: [", "mine.yaml:"),
        ("# A line", "? [a]\n: 1", "mine.yaml:1: a key is a single word"),
        ("# A line", "a: &a [*a]", "mine.yaml:"),
    ],
)
def test_it_is_refused(tmp_path: Path, old: str, new: str, message: str) -> None:
    assert old in GOOD
    said = wrong(tmp_path, GOOD.replace(old, new, 1))
    assert any(message in line for line in said), said


def test_everything_is_told_at_once(tmp_path: Path) -> None:
    text = (
        GOOD.replace("period: 0.01", "perod: 0.01")
        .replace("[3, 1]", "[30, 1]")
        .replace("length: 4", "length: x")
    )
    said = wrong(tmp_path, text)
    assert [line.split(":")[1] for line in said] == ["3", "7", "12"]


def test_a_urdf_without_the_joints_is_refused(tmp_path: Path) -> None:
    (tmp_path / "body.urdf").write_text("<robot name='x'><link name='base_link'/></robot>")
    said = wrong(
        tmp_path, GOOD.replace("estimator", "robot: {kind: diffdrive, urdf: body.urdf}\nestimator", 1)
    )
    assert "mine.yaml:10: robot.urdf: " in said[0]
    assert "left_wheel_joint" in said[0]


def test_what_a_recorded_file_lacks_is_told_with_its_place(tmp_path: Path) -> None:
    (tmp_path / "log.npz").write_bytes(b"no zip at all")
    text = "duration: 1\nplant: {kind: recorded, file: log.npz}\nestimator: ekf\nperod: 1\n"
    said = wrong(tmp_path, text)
    assert said[0].startswith("mine.yaml:2: plant.file: log.npz: ")
    assert said[1].startswith("mine.yaml:4: unknown key 'perod'")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("run", "dmeo"), "unknown scenario 'dmeo'; did you mean 'demo'?"),
        (("run", "nowhere.yaml"), "there is no file nowhere.yaml"),
        (("run", "/"), "/ is not a file"),
        (("run", "x" * 300), "File name too long"),
        (("check", "demo", "--set", "a.b=1"), "--set a.b=1: unknown key 'a'"),
        (("run", "demo", "--record", "some"), "invalid choice"),
        (("run", "demo", "--seed", "-1"), "seed"),
        (("run", "demo", "--set", "duration"), "give PATH=VALUE"),
        (("run", "demo", "--set", "sensors.camera.rat=5"), "--set sensors.camera.rat=5: unknown key 'rat'"),
        (("run", "demo", "--set", "duration=1", "--out", "/dev/null"), "/dev/null"),
        (("run", "demo", "--set", "duration=1", "--out", "/proc/run"), "/proc/run"),
        (("sweep", "demo", "--seeds", "5..1"), "there is no seed"),
        (("sweep", "demo", "--seeds", "1..2", "--set", "bus.interface=virtual"), "cannot share a bus"),
        (("sweep", "demo", "--seeds", "a"), "give A..B"),
        (("sweep", "demo", "--seeds", "1..2", "--jobs", "0"), "--jobs 0"),
        (("sweep", "demo", "--seeds", "1..99999999999999999999"), "more than 100000 seeds"),
        (("run", "demo", "--set", "duration=1", "--out", "x" * 300), "File name too long"),
        (("report", "nowhere"), "nowhere"),
        (("fit", "nowhere"), "nowhere"),
        (("bench", "dmeo"), "did you mean 'demo'?"),
        (("frobnicate",), "invalid choice"),
        ((), "required"),
    ],
)
def test_a_command_that_cannot_be_taken_ends_with_4(
    arguments: tuple[str, ...], message: str, tmp_path: Path
) -> None:
    ended = hilbed(*arguments, cwd=tmp_path)
    assert ended.status == 4, ended.err
    assert message in ended.err
    assert "Traceback" not in ended.err
    assert list(tmp_path.iterdir()) == []


def test_a_recorded_robot_is_on_no_bus(tmp_path: Path) -> None:
    text = "duration: 1\nplant: {kind: recorded, file: log.npz}\nbus: {interface: virtual}\nestimator: ekf\n"
    said = wrong(tmp_path, text)
    assert any(line.startswith("mine.yaml:3: bus.interface: virtual; a recorded robot") for line in said), (
        said
    )


@pytest.mark.parametrize("content", [b"", b"no zip", b"PK\x03\x04" + bytes(100)])
def test_fit_refuses_what_is_no_run(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "signals.npz").write_bytes(content)
    ended = hilbed("fit", tmp_path)
    assert (ended.status, ended.out) == (4, "")
    assert "holds no readable signals.npz" in ended.err


@pytest.mark.parametrize("rows", [0, 1, 10])
def test_fit_refuses_a_run_that_does_not_fit_together(tmp_path: Path, rows: int) -> None:
    t = 0.1 * np.arange(200)
    np.savez(tmp_path / "signals.npz", t=t, beacons=np.zeros((2, 2)), truth=np.zeros((rows, 3)))
    ended = hilbed("fit", tmp_path)
    assert (ended.status, ended.out) == (4, "")
    assert "Traceback" not in ended.err
