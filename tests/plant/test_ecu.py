"""Drives whose firmware is elsewhere: in lockstep the run is the same to the last bit."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import pytest

from hilbed.can import driver_threads, terminals
from hilbed.runner import perform
from hilbed.scenario.load import load
from hilbed.types import ScenarioError
from tests.build.scenarios import small
from tests.plant.firmware import process, threaded
from tests.plant.hub import QUICK, Hub

HASHES = ("hash", "signals_hash")


def run(folder: Path, *settings: str) -> dict[str, Any]:
    """Runs 0.3 s of the small scenario and returns its verdict."""
    loaded = load(str(small(folder)), ["duration=0.3", *settings])
    return dict(perform(loaded, None).verdict)


def on(interface: str, channel: str, *ecus: str) -> list[str]:
    joined = [f"bus.interface={interface}", f"bus.channel={channel}"]
    return joined + [f"nodes.{name}=ecu" for name in ecus]


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """The run with all firmware in this process and no other bus."""
    verdict = run(tmp_path_factory.mktemp("alone"))
    assert verdict["sim_time"] == 0.3
    assert verdict["reason"] == ""
    return verdict


# For a machine that is busy: no cycle is skipped, nobody fails for being late.
PATIENT = ["duration=0.4", "period=0.2", "bus.silent=hold", "realtime.tolerance=60", "sensors={}",
           "estimator=odometry"]  # fmt: skip


def assert_same(verdict: dict[str, Any], alone: dict[str, Any]) -> None:
    assert verdict["reason"] == ""
    assert [verdict[name] for name in HASHES] == [alone[name] for name in HASHES]


@pytest.mark.parametrize("ecus", [("left",), ("left", "right")], ids="+".join)
def test_over_the_virtual_bus(tmp_path: Path, alone: dict[str, Any], ecus: tuple[str, ...]) -> None:
    channel = f"ecu {'+'.join(ecus)}"
    with threaded(channel, *[{"left": 1, "right": 2}[name] for name in ecus]):
        assert_same(run(tmp_path, *on("virtual", channel, *ecus)), alone)


TRICYCLE = """\
duration: 0.3
robot: {kind: tricycle, drive: front, start: [0, 0, 0]}
plant: {kind: bullet, steering: {start: -0.1, switch: 0.05}}
nodes: {steering: {homing: 19}}
estimator: odometry
controller: open_loop
reference: {kind: circle, radius: 2, speed: 0.4}
"""


@pytest.mark.parametrize("mode", ["csp", "pp"])
def test_a_steering_axis_that_looks_for_its_home(tmp_path: Path, mode: str) -> None:
    """Its switch is here and its firmware elsewhere: the inputs are frames, too."""
    file = tmp_path / "tricycle.yaml"
    file.write_text(TRICYCLE)
    settings = [f"nodes.steering.mode={mode}"]
    alone = perform(load(str(file), settings), None).verdict
    assert alone["reason"] == ""
    channel = f"steering {mode}"
    joined = ["bus.interface=virtual", f"bus.channel={channel}", "nodes.steering.kind=ecu"]
    with threaded(channel, 2):
        assert_same(dict(perform(load(str(file), [*settings, *joined]), None).verdict), dict(alone))


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in QUICK.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setattr(driver_threads, "TOO_OLD", 10.0)


@pytest.mark.parametrize("ecus", [{"left": 1}, {"left": 1, "right": 2}], ids="+".join)
@pytest.mark.usefixtures("quick")
def test_processes_on_serial_adapters(tmp_path: Path, alone: dict[str, Any], ecus: dict[str, int]) -> None:
    with Hub(1 + len(ecus)) as hub, ExitStack() as stack:
        for number, path in zip(ecus.values(), hub.paths[1:], strict=True):
            stack.enter_context(process(number, "slcan", path))
        assert_same(run(tmp_path, *on("slcan", hub.paths[0], *ecus)), alone)


def test_the_same_process_serves_one_run_after_the_other(tmp_path: Path, alone: dict[str, Any]) -> None:
    with threaded("again", 1):
        for _ in range(2):
            assert_same(run(tmp_path, *on("virtual", "again", "left")), alone)


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("apart", [False, True], ids=["on the bus", "pins on a channel of their own"])
def test_in_real_time_late_answers_are_counted(tmp_path: Path, apart: bool) -> None:
    with Hub(2) as hub, Hub(2) as pins:
        terminal = ["--terminal", "slcan", pins.paths[1]] if apart else []
        settings = [f"terminal.{key}={value}" for key, value in
                    (("interface", "slcan"), ("channel", pins.paths[0])) if apart]  # fmt: skip
        with process(1, "slcan", hub.paths[1], *terminal):
            verdict = run(tmp_path, *on("slcan", hub.paths[0], "left"), *settings, *PATIENT)
    assert verdict["reason"] == ""
    assert verdict["nodes"] == {"left": "ecu", "right": "simulated"}
    assert set(verdict["realtime"]["late_answers"]) == {"left", "right", "left pins"}
    assert 0 <= verdict["realtime"]["late_answers"]["left pins"] <= 4400  # ticks of boot, run and stop


@pytest.fixture
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(terminals, "PATIENCE", 0.2)


@pytest.mark.usefixtures("impatient")
def test_firmware_that_does_not_come_up(tmp_path: Path) -> None:
    outcome = perform(load(str(small(tmp_path)), on("virtual", "nobody", "left", "right")), None)
    assert outcome.status == 7
    assert "drive left (node 1), drive right (node 2)" in outcome.verdict["reason"]
    assert "python -m firmware_sim --node 1" in outcome.verdict["reason"]


@pytest.mark.usefixtures("impatient")
def test_firmware_that_falls_silent(tmp_path: Path) -> None:
    loaded = load(str(small(tmp_path)), ["duration=0.3", *on("virtual", "silent", "right")])
    with dies_after("silent", 2, 1200):
        outcome = perform(loaded, None)
    assert outcome.status == 7
    assert outcome.verdict["reason"].startswith("t = 0.2 s: drive right (node 2): no answer")


@contextmanager
def dies_after(channel: str, node: int, ticks: int) -> Iterator[None]:
    """Runs firmware that answers so many ticks."""
    answered = 0

    class Dying(terminals.Terminal):
        def take(self, data: bytes) -> None:
            nonlocal answered
            answered += bool(data)
            if answered <= ticks:
                super().take(data)

    with pytest.MonkeyPatch.context() as patch, threaded(channel, node):
        patch.setattr(terminals, "Terminal", Dying)
        yield


def test_two_processes_for_one_node(tmp_path: Path) -> None:
    with threaded("twins", 1, 1):
        outcome = perform(load(str(small(tmp_path)), on("virtual", "twins", "left")), None)
    assert outcome.status == 7
    assert "drive left (node 1): two processes are its firmware" in outcome.verdict["reason"]


def test_elsewhere_without_a_bus(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match="left is elsewhere, but the wire is joined to no"):
        perform(load(str(small(tmp_path)), ["nodes.left=ecu"]), None)


def test_a_channel_of_its_own_is_refused_in_lockstep(tmp_path: Path) -> None:
    settings = on("virtual", "two channels", "left")
    with pytest.raises(ScenarioError, match="terminal: two channels keep no order between them"):
        perform(load(str(small(tmp_path)), [*settings, "terminal={interface: virtual, channel: pins}"]), None)
