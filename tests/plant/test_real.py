"""Drives that are real and elsewhere; `hilbed drive` on serial adapters is the real one."""

from __future__ import annotations

from math import atan, nan, pi
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed.can import driver_threads, wake
from hilbed.can.codec import DataType, PdoCodec
from hilbed.can.drive_table import load_table
from hilbed.can.node import Node
from hilbed.can.reported import Reported
from hilbed.can.wire import Wire
from hilbed.plant.axes import RealSteeringAxis
from hilbed.record.folder import RunFolder
from hilbed.robots.diffdrive import DiffDrive, DiffDriveSpec
from hilbed.robots.limited import Limited
from hilbed.runner import Watch, perform
from hilbed.scenario.load import Loaded, load
from hilbed.types import Command, Frame, ScenarioError
from tests.build.scenarios import small
from tests.drive.test_process import drive, master, ready
from tests.plant.hub import QUICK, Hub

# For a machine that is busy: drives wait for three cycles of heartbeat and five of SYNC, none is skipped.
PATIENT = ["period=0.2", "bus.silent=hold", "realtime.tolerance=60", "estimator=odometry", "sensors={}"]


@pytest.fixture(autouse=True)
def _quick(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in QUICK.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setattr(driver_threads, "TOO_OLD", 10.0)


def scenario(folder: Path, *settings: str) -> Loaded:
    return load(str(small(folder)), ["nodes.left=real", *settings])


def on(path: str) -> list[str]:
    return [f"bus.channel={path}", "bus.interface=slcan"]


def test_the_wheel_goes_as_fast_as_the_drive_says(tmp_path: Path) -> None:
    with Hub(2) as hub, drive(hub.paths[1], "--node", "1", "--friction", "0.5") as running:
        ready(running)
        loaded = scenario(tmp_path, *on(hub.paths[0]), *PATIENT, "duration=2", "real_speed_limit=0.2")
        outcome = perform(loaded, RunFolder(tmp_path / "run", force=False), armed=True)
    assert (outcome.verdict["reason"], outcome.verdict["events"]) == ("", [])
    assert outcome.verdict["nodes"] == {"left": "real", "right": "simulated"}
    signals = np.load(tmp_path / "run" / "signals.npz")
    left = {
        name: signals[f"drive/left/{name}"] for name in ("speed", "speed_measured", "speed_ref", "current")
    }
    assert np.all(np.isnan(signals["drive/left/duty"][1:]))
    assert np.all(np.abs(left["speed_ref"]) <= 2.0 * (1 + 1e-4))  # 0.2 m/s at the rim of a wheel of 0.1 m
    assert left["speed"][-1] == pytest.approx(2.0, abs=0.1)
    # A wheel that grips follows within its tick what came last over the bus.
    assert left["speed"][2:] == pytest.approx(left["speed_measured"][2:], abs=1e-3)
    assert left["current"][-3:].mean() > 0.3  # the brake on the desk
    assert signals["truth"][-1, 0] > 0.1


TRICYCLE = """\
duration: 3
period: 0.2
robot: {kind: tricycle, drive: front, start: [0, 0, 0], max_steering: 0.5}
plant: bullet
nodes: {steering: real}
estimator: odometry
controller: open_loop
reference: {kind: circle, radius: 2, speed: 0.2}
"""


@pytest.mark.parametrize("mode", ["csp", "pp"])
def test_a_steering_axis_stands_at_the_angle_that_the_drive_says(tmp_path: Path, mode: str) -> None:
    file = tmp_path / "tricycle.yaml"
    file.write_text(TRICYCLE)
    table = ("--table", f"hilbed402-{mode}")
    with (
        Hub(3) as hub,
        drive(hub.paths[1], "--node", "2", *table) as running,
        master(hub.paths[2], 2) as other,
    ):
        ready(running)
        settings = [f"nodes.steering={{kind: real, mode: {mode}}}", *on(hub.paths[0]), *PATIENT]
        outcome = perform(load(str(file), settings), RunFolder(tmp_path / "run", force=False), armed=True)
        assert other.read(0x607F) == round(2.0 / (2 * pi) * 66_000)  # max_steering_rate
    assert (outcome.verdict["reason"], outcome.verdict["events"]) == ("", [])
    assert outcome.verdict["nodes"] == {"traction": "simulated", "steering": "real"}
    signals = np.load(tmp_path / "run" / "signals.npz")
    angle = signals["tick/drive/steering/angle"]
    assert angle[-1] == pytest.approx(atan(0.5), abs=0.01)  # wheelbase 1 m, radius 2 m
    assert np.isnan(signals["tick/drive/steering/duty"][-1])
    assert signals["truth"][-1, 2] > 0.1


def test_an_axis_that_is_led_catches_up_with_what_is_reported() -> None:
    """However it came to be elsewhere, and without a lasting error."""

    class Said:
        speed, angle, current, speed_ref = 0.5, 0.0, 0.1, nan

    said, axis_angle = Said(), 0.3
    axis = RealSteeringAxis("steering", said, 7.0)
    for k in range(1000):
        said.angle = 0.5e-3 * k
        axis.step(k * 1_000_000, axis_angle, 0.0, 24.0, 96)
        assert axis.target is not None
        axis_angle += 1e-3 * axis.target
    assert axis_angle == pytest.approx(0.5, abs=1e-3)
    said.speed = said.angle = nan  # a drive that has said nothing yet
    axis.step(0, axis_angle, 0.0, 24.0, 96)
    assert axis.target == 0.0


def test_the_limit_is_in_the_drive_itself(tmp_path: Path) -> None:
    """Nobody has to ask the bench: 607F holds it."""
    with Hub(3) as hub, drive(hub.paths[1], "--node", "1") as running, master(hub.paths[2], 1) as other:
        ready(running)
        loaded = scenario(tmp_path, *on(hub.paths[0]), *PATIENT, "duration=0.2", "real_speed_limit=0.2")
        outcome = perform(loaded, None, armed=True)
        assert outcome.verdict["reason"] == ""
        assert other.read(0x607F) == round(2.0 / (2 * pi) * 66_000)


@pytest.mark.parametrize("number", [2, 5])
def test_other_drives_on_the_bus_are_refused(tmp_path: Path, number: int) -> None:
    """Node 2 should be simulated, node 5 is not in the scenario at all."""
    with (
        Hub(3) as hub,
        drive(hub.paths[1], "--node", "1") as first,
        drive(hub.paths[2], "--node", str(number)) as second,
    ):
        ready(first)
        ready(second)
        beat(hub.paths[0], number)
        outcome = perform(scenario(tmp_path, *on(hub.paths[0]), *PATIENT, "duration=1"), None, armed=True)
    assert outcome.status == 7
    told = {2: "two nodes with one number", 5: "node 5 is a drive"}[number]
    assert told in outcome.verdict["reason"]


def beat(path: str, number: int) -> None:
    """Sets a drive's heartbeat going, as who has used it before may have done."""
    with master(path, number) as other:
        other.write(0x1017, 20, 2)


def test_refused_without_a_word_that_it_may(tmp_path: Path) -> None:
    with pytest.raises(
        ScenarioError, match=r"left is real: this run moves a real motor, at 0.1 m/s .* --arm"
    ):
        perform(scenario(tmp_path, "realtime={}"), None)


def test_refused_in_lockstep(tmp_path: Path) -> None:
    settings = ["bus.interface=virtual", "bus.channel=lockstep"]
    with pytest.raises(ScenarioError, match=r"left is real, and a real drive does not wait .* --realtime"):
        perform(scenario(tmp_path, *settings), None, armed=True)


def test_a_real_drive_that_is_not_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(wake, "PATIENCE", 0.2)
    settings = ["bus.interface=virtual", "bus.channel=empty", "realtime={}"]
    outcome = perform(scenario(tmp_path, *settings), None, armed=True)
    assert outcome.status == 7
    assert outcome.verdict["reason"].startswith("drive left (node 1): no boot-up message")


def test_waiting_for_a_real_drive_ends_when_it_is_told_to(tmp_path: Path) -> None:
    settings = ["bus.interface=virtual", "bus.channel=empty", "realtime={}"]
    asked = iter([None, None, "SIGTERM"])
    watch = Watch(stop=lambda: next(asked))
    outcome = perform(scenario(tmp_path, *settings), None, watch=watch, armed=True)
    assert (outcome.status, outcome.verdict["reason"]) == (2, "SIGTERM while the drives were brought up")


def test_refused_without_a_bus(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match="left is elsewhere, but the wire is joined to no bus"):
        perform(scenario(tmp_path, "realtime={}"), None, armed=True)


speeds = st.floats(-5.0, 5.0)


@given(speeds, speeds, st.floats(0.1, 50.0), st.none() | st.floats(0.1, 50.0))
def test_a_limit_keeps_the_path(v: float, w: float, left: float, right: float | None) -> None:
    robot = DiffDrive(DiffDriveSpec())
    asked = robot.wheel_speeds(Command(v, w))
    given = Limited(robot, [left, right]).wheel_speeds(Command(v, w))
    for speed, limit in zip(given, (left, right), strict=True):
        assert limit is None or abs(speed) <= limit * (1 + 1e-12)
    assert asked[0] * given[1] == pytest.approx(asked[1] * given[0], abs=1e-9)
    if all(limit is None or abs(speed) <= limit for speed, limit in zip(asked, (left, right), strict=True)):
        assert given == asked


@pytest.mark.parametrize("polarity", [1, -1])
@pytest.mark.parametrize(("velocity", "unit"), [("rpm", 2 * pi / 60 / 20), ("counts/s", 2 * pi / 4096 / 20)])
def test_what_it_reports_in_the_units_of_its_table(polarity: int, velocity: str, unit: float) -> None:
    """A motor of 20 turns a wheel turn, with 4096 counts each, mounted either way."""
    table = load_table("hilbed402")
    other = {"polarity": polarity, "velocity": velocity, "gear": 20.0, "counts_per_turn": 4096.0}
    node = Node("left", 3, table.model_copy(update={"units": table.units.model_copy(update=other)}))
    wire = Wire(500_000)
    reported, drive_port, bench = Reported(node, wire.attach), wire.attach("drive"), wire.attach("bench")
    types: list[tuple[str, DataType]] = [("statusword", "u16"), ("velocity", "i32"), ("torque", "i16")]
    drive_port.send(0, Frame(0x183, PdoCodec(types).pack(0x27, 1234, 0)))
    drive_port.send(0, Frame(0x283, PdoCodec([("position", "i32"), ("current", "i16")]).pack(0, 500)))
    bench.send(0, Frame(0x203, PdoCodec([("controlword", "u16"), ("target", "i32")]).pack(0x0F, -77)))
    drive_port.send(0, Frame(0x183, b"\0"))  # shorter than its mapping: not heeded
    wire.advance(10_000_000)
    assert reported.speed == pytest.approx(polarity * 1234 * unit)
    assert reported.speed_ref == pytest.approx(polarity * -77 * unit)
    assert reported.current == pytest.approx(polarity * 0.5 * table.units.rated_current)
