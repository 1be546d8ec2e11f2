"""A robot whose wheels are two axes of one node, run by the same controller as any other."""

from __future__ import annotations

from math import tau
from pathlib import Path

import can
import cantools
import numpy as np
import pytest

from hilbed.can.base import CanBase
from hilbed.can.dbc import dbc
from hilbed.can.drive_table import load_table
from hilbed.can.load import periodic_load
from hilbed.can.node import Node
from hilbed.can.specs import BusSpec, NodeSpec, resolve
from hilbed.record.folder import RunFolder
from hilbed.replay.command import perform as replay
from hilbed.replay.differences import differences
from hilbed.replay.recording import read_recording
from hilbed.robots.diffdrive import DiffDrive, DiffDriveSpec
from hilbed.runner import perform
from hilbed.scenario.load import load
from hilbed.types import Command, Frame, Nanos, Received, ScenarioError

TABLE = load_table("zlac8015d")
TWO = {"left": NodeSpec(table="zlac8015d", id=3, axis=1), "right": NodeSpec(table="zlac8015d", id=3, axis=2)}
NODES = resolve(TWO, ("left", "right"))
SCENARIO = [
    "duration=3",
    "disturbances=[]",
    "criteria={}",
    "nodes.left={table: zlac8015d, id: 3, axis: 1}",
    "nodes.right={table: zlac8015d, id: 3, axis: 2}",
]


class Tape:
    """A bus that keeps what is sent and hands out what it was given."""

    def __init__(self) -> None:
        self.sent: list[Frame] = []
        self.coming: list[Received] = []

    def send(self, t: Nanos, frame: Frame) -> None:  # noqa: ARG002
        self.sent.append(frame)

    def recv(self, t: Nanos) -> list[Received]:  # noqa: ARG002
        coming, self.coming = self.coming, []
        return coming


def test_one_frame_carries_both_targets() -> None:
    bus, robot = Tape(), DiffDrive(DiffDriveSpec(wheel_radius=0.1, track=0.4))
    CanBase(robot, bus, NODES, BusSpec()).write(0, Command(0.5, 0.0))
    orders = {frame.id: frame.data for frame in bus.sent}
    rpm = round(0.5 / 0.1 * 60 / tau)
    assert orders[0x203] == rpm.to_bytes(4, "little", signed=True) + (-rpm).to_bytes(4, "little", signed=True)
    assert orders[0x303] == b"\x0f\x00"
    assert [frame.id for frame in bus.sent].count(0x203) == 1


def test_one_frame_tells_of_both_wheels() -> None:
    bus, robot = Tape(), DiffDrive(DiffDriveSpec(wheel_radius=0.1, track=0.4))
    base = CanBase(robot, bus, NODES, BusSpec())

    def say(left: int, right: int, rate: int) -> None:
        """Positions in counts, speeds in tenths of a revolution a minute; axis 2 is mirrored."""
        pair = (left.to_bytes(4, "little", signed=True), (-right).to_bytes(4, "little", signed=True))
        rates = (rate.to_bytes(4, "little", signed=True), (-rate).to_bytes(4, "little", signed=True))
        status = b"\x37\x02\x37\x02" + (15).to_bytes(2, "little") + (-15).to_bytes(2, "little", signed=True)
        frames = [Frame(0x183, status), Frame(0x283, b"".join(rates)), Frame(0x383, b"".join(pair))]
        bus.coming = [Received(1, frame) for frame in frames]

    base.write(0, Command(0.0, 0.0))
    say(1000, 1000, 0)
    base.read(5)
    base.write(10, Command(0.0, 0.0))
    say(1000 + 4096, 1000 + 2048, 600)
    odometry = base.read(15)
    assert odometry.distance == pytest.approx(0.75 * tau * 0.1)
    assert odometry.turn == pytest.approx(-0.5 * tau * 0.1 / 0.4)
    assert odometry.v == pytest.approx(tau * 0.1)  # 60 rpm
    assert odometry.drives["left"].current_measured == pytest.approx(1.5)
    assert odometry.drives["right"].current_measured == pytest.approx(1.5)
    assert base.faulted == ()


def test_a_fault_of_one_axis_is_its_own() -> None:
    bus, robot = Tape(), DiffDrive(DiffDriveSpec())
    base = CanBase(robot, bus, NODES, BusSpec())
    base.write(0, Command(0.0, 0.0))
    bus.coming = [Received(1, Frame(0x183, b"\x37\x02\x18\x02" + bytes(4)))]
    base.read(5)
    assert base.faulted == ("right",)


def test_the_bench_runs_on_it_and_a_replay_is_identical(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    outcome = perform(load("demo", SCENARIO, seed=1), RunFolder(folder))
    assert outcome.verdict["reason"] == ""
    assert outcome.verdict["metrics"]["cross_track_rms"] < 0.02
    recording = read_recording(folder)
    assert differences(recording.signals, replay(recording).signals) == []
    database = cantools.database.load_file(folder / "bus.dbc")
    speeds = [
        database.decode_message(message.arbitration_id, message.data)
        for message in can.LogReader(folder / "can.log")
        if message.arbitration_id == 0x283
    ]
    for drive in ("left", "right"):
        decoded = {round(speed[f"{drive}_velocity_actual"], 9) for speed in speeds}
        with np.load(folder / "signals.npz") as signals:
            measured = signals[f"drive/{drive}/speed_measured"]
            true = signals[f"drive/{drive}/speed"]
        assert {round(value, 9) for value in measured[np.isfinite(measured)].tolist()} <= decoded
        assert np.nanmean(measured) == pytest.approx(true.mean(), rel=0.05)


def test_the_load_counts_a_node_once() -> None:
    alone = periodic_load([NODES[0]], 0.01, 500_000)
    assert periodic_load(NODES, 0.01, 500_000) == alone
    # SYNC, heartbeats (100 ms), and in 10 ms 2 RPDOs of 8 and 2 bytes, 3 TPDOs of 8; TPDO4 of 5 in 100 ms
    bits = (55 + 135 + 75 + 3 * 135) / 0.01 + (2 * 65 + 105) / 0.1
    assert alone == pytest.approx(bits / 500_000, rel=0.02)


def test_signals_are_named_after_their_drives() -> None:
    text = dbc(NODES)
    database = cantools.database.load_string(text, "dbc")
    message = database.get_message_by_name("left_right_tpdo1")
    assert {signal.name for signal in message.signals} == {
        f"{drive}_{word}" for drive in ("left", "right") for word in ("statusword", "current_actual")
    }


@pytest.mark.parametrize(
    ("right", "words"),
    [
        ({"table": "zlac8015d", "id": 3, "axis": 1}, "both axis 1 of node 3"),
        ({"table": "hilbed402", "id": 3}, "same node number 3"),
        ({"table": "zlac8015d", "id": 3, "axis": 2, "kind": "real"}, "one kind"),
    ],
)
def test_axes_that_do_not_fit_together_are_told(right: dict[str, object], words: str) -> None:
    with pytest.raises(ScenarioError, match=words):
        resolve({"left": TWO["left"], "right": NodeSpec.model_validate(right)}, ("left", "right"))


@pytest.mark.parametrize(
    ("spec", "words"),
    [
        ({"axis": 3}, "axis 3: zlac8015d has 2"),
        ({"kind": "ecu"}, "an ecu node has one axis"),
        ({"mode": "csv"}, "no mode 'csv'; it has pv"),
        ({"loop": "pi"}, "no setting 'loop'"),
    ],
)
def test_what_the_drive_does_not_have_is_told(spec: dict[str, object], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        NodeSpec.model_validate({"table": "zlac8015d", **spec})


def test_defaults_are_those_that_the_drive_takes() -> None:
    spec = TWO["left"]
    assert (spec.mode, spec.loop) == ("pv", None)
    assert NodeSpec.model_validate(spec.model_dump()) == spec
    assert str(Node("left", 3, TABLE)) == "drive left (node 3, axis 1)"
