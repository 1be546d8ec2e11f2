"""Faults of the bus through the whole bench: it ends with a verdict, the robot stands, and it says why."""

from __future__ import annotations

import json
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from hilbed import loop
from hilbed.build import build
from hilbed.clock import nanos
from hilbed.cost import Cost
from hilbed.record.notes import Notes
from hilbed.runner import perform
from hilbed.scenario.load import load
from hilbed.types import BusError, ScenarioError
from tests.build.scenarios import small
from tests.program.hilbed import hilbed

CALM = ("sensors={}", "estimator=odometry", "controller=open_loop", "duration=1.2")
STANDS = 0.1  # rad/s


class Case(NamedTuple):
    """A fault from 0.3 s on: its block, exit status, a word of the reason, a word of an event."""

    block: str
    status: int
    reason: str
    event: str


CASES = {
    "some dropped": Case("drop, node: left, probability: 0.1", 0, "", "left: 20 frames lost"),
    "all of a drive dropped": Case("drop, node: left", 7, "left (node 1) has been silent", "left: silent"),
    "SYNC dropped": Case("drop, identifier: 0x80", 7, "silent since 0.3", "right: emergency 8100"),
    "all of the controller dropped": Case("drop, node: controller", 7, "silent", "left: emergency 8100"),
    "some corrupted": Case("corrupt, probability: 0.1", 0, "", "controller: 37 frames corrupted"),
    "all of a drive corrupted": Case("corrupt, node: left", 7, "silent", "left: bus-off"),
    "all of the controller corrupted": Case("corrupt, node: controller", 7, "", "controller: error passive"),
    "short delay": Case("delay, node: left, delay: 0.02", 0, "", "left: 244 frames delayed"),
    "long delay": Case("delay, node: left, delay: 0.2", 7, "left (node 1) has been silent", "delayed"),
    "duplicate": Case("duplicate", 0, "", "controller: 339 frames sent twice"),
    "babbling": Case("babbling_node, rate: 2000", 0, "", "babbler: 2180 frames sent"),
    "babbling all the time": Case("babbling_node, rate: 20000", 7, "silent", "babbler: "),
    "bus-off of a drive": Case("bus_off, node: left", 7, "left (node 1) has been silent", "left: bus-off"),
    "bus-off of a drive for a while": Case("bus_off, node: left, length: 0.03", 0, "", "left: error active"),
    "bus-off of the controller": Case(
        "bus_off, node: controller",
        7,
        "t = 0.3 s: controller cannot send 080",
        "controller: bus-off",
    ),
    "lost heartbeat of the controller": Case(
        "lost_heartbeat, node: controller", 7, "silent", "right: emergency 8130: heartbeat"
    ),
    "lost heartbeat of a drive": Case(
        "lost_heartbeat, node: left", 7, "left (node 1) has been without a heartbeat", "lost, all heartbeats"
    ),
    "reset of a drive": Case("node_reset, node: left", 7, "left (node 1) has been silent", "left: without"),
}
KINDS = {case.block.partition(",")[0] for case in CASES.values()}


def settings(case: Case) -> list[str]:
    return [*CALM, f"disturbances=[{{kind: {case.block}, start: 0.3}}]"]


@pytest.mark.parametrize("name", CASES)
def test_it_ends_with_a_verdict_that_says_why_and_the_same_each_time(tmp_path: Path, name: str) -> None:
    case = CASES[name]
    loaded = load(str(small(tmp_path)), settings(case))
    outcome = perform(loaded, None)
    assert (outcome.status, outcome.trace) == (case.status, "")
    assert case.reason in outcome.verdict["reason"]
    assert any(case.event in event for event in outcome.verdict["events"]), outcome.verdict["events"]
    assert perform(loaded, None).verdict["hash"] == outcome.verdict["hash"]


def speeds(file: Path, *chosen: str) -> tuple[int, np.ndarray]:
    """Runs a bench and stops it; returns exit status and speeds (2, M) of both wheels, up to the very end."""
    bench = build(load(str(file), chosen), Notes(), Cost())
    last = status = 0
    try:
        bench.boot(lambda: None)
        try:
            for cycle in loop.run(bench.rig, nanos(1.2)):
                last = cycle.t
        except BusError:
            status = 7
        bench.stop(last)
        ticks = bench.ticks(0)
    finally:
        bench.close()
    return status, np.array([ticks[f"tick/drive/{drive}/speed"] for drive in ("left", "right")])


@pytest.mark.parametrize("name", CASES)
def test_the_robot_stands_in_the_end(tmp_path: Path, name: str) -> None:
    status, speed = speeds(small(tmp_path), *settings(CASES[name]))
    assert status == CASES[name].status
    assert np.abs(speed[:, 290]).min() > 1, "it was under way"
    assert np.abs(speed[:, -1]).max() < STANDS


@pytest.mark.parametrize(
    ("name", "wheels", "still", "stands"),
    [
        ("bus-off of a drive", [0], 330, 450),
        ("bus-off of a drive for a while", [], 330, 450),
        ("SYNC dropped", [0, 1], 330, 450),
        ("all of the controller corrupted", [0, 1], 320, 450),
        ("lost heartbeat of the controller", [0, 1], 440, 620),
    ],
)
def test_a_drive_stops_by_itself(
    tmp_path: Path, name: str, wheels: list[int], still: int, stands: int
) -> None:
    """The controller holds on whatever happens; its last SYNC is at 0.29 s, its last heartbeat at 0.2 s."""
    _, speed = speeds(small(tmp_path), *settings(CASES[name]), "bus.silent=hold")
    assert np.abs(speed[:, still]).min() > 0.5, "no sooner than the drive must"
    standing = [wheel for wheel in (0, 1) if np.abs(speed[wheel, stands]) < STANDS]
    assert standing == wheels


def test_policies_other_than_fail_go_on(tmp_path: Path) -> None:
    for policy in ("hold", "quick_stop"):
        for name in ("reset of a drive", "all of a drive dropped"):
            chosen = [*settings(CASES[name]), f"bus.silent={policy}"]
            outcome = perform(load(str(small(tmp_path)), chosen), None)
            assert outcome.status == 0, outcome.verdict["reason"]


def test_error_frames_are_in_the_folder_of_the_run(tmp_path: Path) -> None:
    """As a user runs it: can.log and signals.npz agree on the error frames, frame by frame."""
    import can

    flags = [word for setting in settings(CASES["some corrupted"]) for word in ("--set", setting)]
    ended = hilbed("run", small(tmp_path), *flags, "--out", tmp_path / "run", "--json")
    assert (ended.status, "Traceback" in ended.err) == (0, False), ended.err
    told = json.loads(ended.out)
    with np.load(tmp_path / "run" / "signals.npz") as signals:
        ends = signals["bus/t"][signals["bus/error"] == 1]
    errors = [message for message in can.LogReader(tmp_path / "run" / "can.log") if message.is_error_frame]
    assert len(errors) == len(ends) == told["metrics"]["bus_errors"] > 50
    assert [message.timestamp - 1 for message in errors] == pytest.approx(ends, abs=2e-6)
    assert "corrupt" in (tmp_path / "run" / "report.html").read_text()


@pytest.mark.parametrize(
    ("block", "where", "why"),
    [
        ("lost_heartbeat, node: wheel", "node", "there is no node 'wheel' on the bus; known: controller"),
        ("bus_off, node: lefft", "node", "did you mean 'left'?"),
        ("node_reset, node: controller", "node", "only a drive can lose its supply; there are left, right"),
        ("drop, identifier: 0x333", "identifier", "nobody sends 0x333"),
        ("drop, node: left, identifier: 0x182", "identifier", "0x182 is sent by right, not by left"),
        ("corrupt, probability: 1.5", "probability", "less than or equal to 1"),
        ("delay, node: left", "delay", "is missing"),
        ("babbling_node, rate: 0", "rate", "greater than 0"),
        ("drop, identifier: 0x800", "identifier", "less than or equal to 2047"),
    ],
)
def test_what_cannot_be_is_refused_with_its_place(tmp_path: Path, block: str, where: str, why: str) -> None:
    file = small(tmp_path)
    file.write_text(file.read_text() + f"disturbances:\n  - {{kind: {block}}}\n")
    line = len(file.read_text().splitlines())
    with pytest.raises(ScenarioError) as refused:
        load(str(file))
    assert str(refused.value).startswith(f"{file}:{line}: disturbances.0.{where}")
    assert why in str(refused.value)


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_a_recorded_robot_has_no_bus(kind: str) -> None:
    block = next(case.block for case in CASES.values() if case.block.startswith(kind))
    with pytest.raises(ScenarioError, match="nothing can disturb a recorded robot"):
        load("recorded/azimuth", [f"disturbances=[{{kind: {block}}}]"])


@pytest.mark.parametrize("kind", ["ecu", "real"])
def test_what_is_elsewhere_cannot_be_taken_off_the_bus(tmp_path: Path, kind: str) -> None:
    why = f"left is {kind}: its CAN controller and its supply are not here"
    for fault in ("bus_off", "node_reset"):
        chosen = [f"nodes={{left: {kind}}}", f"disturbances=[{{kind: {fault}, node: left}}]"]
        with pytest.raises(ScenarioError, match=why):
            load(str(small(tmp_path)), chosen)
