"""A whole bench whose wire is joined to a python-can bus: the run is the same, and it stops when it must."""

from __future__ import annotations

import json
from pathlib import Path

import can
import pytest

from hilbed.build import carriage, hands
from hilbed.can import cia402
from hilbed.can.hardware import Adapter
from hilbed.record.folder import RunFolder
from hilbed.runner import BUS, Outcome, Watch, perform
from hilbed.scenario.load import load
from hilbed.types import BusError, Cycle, Frame

SCENARIO = "slimane2014/load-torque"
SHORT = ["duration=0.3", "criteria={}"]
JOINED = [*SHORT, "bus.interface=virtual", "bus.channel=joined"]


def run(settings: list[str], folder: Path | None = None, watch: Watch | None = None) -> Outcome:
    return perform(load(SCENARIO, settings), None if folder is None else RunFolder(folder), watch)


def frames_of(witness: can.BusABC) -> list[tuple[int, bytes]]:
    """Returns identifier and data of all that another node on the bus has heard."""
    messages = iter(lambda: witness.recv(0), None)
    return [(message.arbitration_id, bytes(message.data)) for message in messages if message is not None]


def words(frames: list[tuple[int, bytes]], node: int) -> list[int]:
    """Returns the controlwords that a node is sent by PDO."""
    return [int.from_bytes(data[:2], "little") for identifier, data in frames if identifier == 0x200 + node]


def hashes(outcome: Outcome) -> tuple[str, str]:
    assert outcome.status == 0, outcome.verdict["reason"]
    return outcome.verdict["hash"], outcome.verdict["signals_hash"]


def test_over_another_bus_the_run_is_the_same_and_every_frame_is_on_it(tmp_path: Path) -> None:
    with can.Bus(interface="virtual", channel="joined") as witness:
        joined = run(JOINED, tmp_path / "run")
        heard = frames_of(witness)
    assert hashes(joined) == hashes(run(SHORT))
    log = can.LogReader(tmp_path / "run" / "can.log")
    assert [(message.arbitration_id, bytes(message.data)) for message in log] == heard
    assert joined.verdict["adapter"]["name"] == "virtual joined"
    assert joined.verdict["adapter"]["sent"] == len(heard)


def test_in_real_time_the_run_is_the_same_where_no_deadline_is_missed() -> None:
    simulated = run(SHORT)
    paced = run([*SHORT, "realtime={tolerance: 100, give_up: 100}"])
    assert hashes(paced) == hashes(simulated)
    part = paced.verdict["realtime"]
    assert (part["cycles"], part["missed_deadlines"], sum(part["histogram"]["cycles"])) == (31, 0, 31)
    assert set(part["late_answers"]) == {"left", "right"}
    assert "realtime" not in simulated.verdict
    assert paced.verdict["metrics"]["lateness_max"] == part["lateness"]["worst"]


def test_a_deadline_that_nobody_could_meet_fails_the_run_if_the_scenario_says_so() -> None:
    outcome = run([*SHORT, "realtime={overrun: fail, tolerance: 1.0e-9}"])
    assert outcome.status == 3
    assert "real time lost" in outcome.verdict["reason"]
    assert outcome.verdict["realtime"]["missed_deadlines"] == 1


def test_missed_deadlines_are_a_criterion_and_their_commands_are_not_sent() -> None:
    """Every deadline is missed, so the drives are never told to move, only to stop."""
    settings = [
        "duration=0.3",
        "criteria={missed_deadlines: {max: 0}}",
        "realtime={tolerance: 1.0e-9, give_up: 100}",
    ]
    with can.Bus(interface="virtual", channel="joined") as witness:
        outcome = run([*settings, *JOINED[-2:]])
        heard = frames_of(witness)
    entry = outcome.verdict["criteria"]["missed_deadlines"]
    assert (outcome.status, entry["passed"], entry["value"]) == (1, False, 31)
    assert set(words(heard, 1)) == set(words(heard, 2)) == {cia402.QUICK_STOP}


class Failing(Adapter):
    """An adapter whose bus is lost at the frame `at`; back: it is there again after that one."""

    at, back = 400, True

    def __init__(self, *names: object) -> None:
        super().__init__(*names)  # type: ignore[arg-type]
        self.asked = 0

    def send(self, frame: Frame) -> None:
        self.asked += 1
        if self.asked == self.at or (self.asked > self.at and not self.back):
            raise BusError(f"{self.name}: lost while sending: Transmit buffer full")
        super().send(frame)


@pytest.fixture
def failing(monkeypatch: pytest.MonkeyPatch) -> type[Failing]:
    monkeypatch.setattr("hilbed.can.hardware.Adapter", Failing)
    return Failing


@pytest.mark.usefixtures("failing")
@pytest.mark.parametrize("back", [True, False])
def test_a_bus_that_is_lost_ends_the_run_and_old_commands_are_never_sent(
    back: bool, failing: type[Failing], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(failing, "back", back)
    with can.Bus(interface="virtual", channel="joined") as witness:
        outcome = run(JOINED, tmp_path / "run")
        heard = frames_of(witness)
    assert outcome.status == BUS
    told = json.loads((tmp_path / "run" / "verdict.json").read_text())
    assert told["reason"].startswith("t = ")
    assert told["reason"].endswith("virtual joined: lost while sending: Transmit buffer full")
    after = heard[failing.at - 1 :]
    for node in (1, 2):
        assert set(words(after, node)) == ({cia402.QUICK_STOP} if back else set())
        stop = (0x600 + node, bytes.fromhex("2b40600002000000"))
        assert after.count(stop) == (1 if back else 0)


def test_at_the_end_of_a_run_the_bench_waits_until_the_drives_say_that_they_stand() -> None:
    with can.Bus(interface="virtual", channel="joined") as witness:
        assert run(JOINED).status == 0
        heard = frames_of(witness)
    for node in (1, 2):
        last = [data for identifier, data in heard if identifier == 0x180 + node][-1]
        assert cia402.state_of(int.from_bytes(last[:2], "little")) != cia402.ENABLED
        assert abs(int.from_bytes(last[2:6], "little", signed=True)) < 0.1 * 66_000 / 6.28
        assert words(heard, node)[-1] == cia402.QUICK_STOP


class Twin:
    """Somebody on the other bus who answers as node 1 from its first frame on."""

    def __init__(self, says: can.Message) -> None:
        self.bus = can.Bus(interface="virtual", channel="joined")
        self.says = says

    def __enter__(self) -> Twin:
        self.bus.send(self.says)
        return self

    def __exit__(self, *_: object) -> None:
        self.bus.shutdown()


@pytest.mark.parametrize("more", [[], ["realtime.give_up=100"]])
def test_a_node_that_should_be_simulated_answers_on_the_bus(
    more: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    message = can.Message(arbitration_id=0x581, is_extended_id=False, data=bytes(8))
    opened: list[Twin] = []
    start = carriage.Carriage.start

    def also(self: carriage.Carriage, t: int) -> None:
        opened.append(Twin(message).__enter__())
        start(self, t)

    monkeypatch.setattr(carriage.Carriage, "start", also)
    outcome = run([*JOINED, *more])
    opened[0].bus.shutdown()
    assert outcome.status == BUS
    assert (
        "drive left (node 1) is simulated here, but another node on virtual joined sends 581"
        in (outcome.verdict["reason"])
    )


def test_a_stop_asked_for_stops_the_drives_on_the_bus() -> None:
    cycles: list[Cycle] = []
    with can.Bus(interface="virtual", channel="joined") as witness:
        outcome = run(JOINED, watch=Watch(lambda: "SIGTERM" if cycles else None, cycles.append))
        heard = frames_of(witness)
    assert outcome.status == 2
    assert len(cycles) == 1
    assert words(heard, 1)[-1] == words(heard, 2)[-1] == cia402.QUICK_STOP


def test_a_stop_asked_for_while_drives_boot_switches_no_motor_on() -> None:
    with can.Bus(interface="virtual", channel="joined") as witness:
        outcome = run(JOINED, watch=Watch(lambda: "SIGINT"))
        heard = frames_of(witness)
    assert (outcome.status, outcome.verdict["reason"]) == (2, "SIGINT while the drives were brought up")
    told = {
        data[4] for identifier, data in heard if identifier in (0x601, 0x602) and data[1:3] == b"\x40\x60"
    }
    assert told == {cia402.QUICK_STOP}


def test_standstill_is_waited_for_no_longer_than_its_deadline(monkeypatch: pytest.MonkeyPatch) -> None:
    """A drive that is told that nothing stands is never at rest."""
    monkeypatch.setattr("hilbed.can.base.STANDING", 0.0)
    outcome = run(SHORT)
    assert outcome.status == 0
    assert [event.split(": ", 1)[1] for event in outcome.verdict["events"]] == [
        f"left: {hands.NOT_STOPPED}", f"right: {hands.NOT_STOPPED}",
    ]  # fmt: skip
