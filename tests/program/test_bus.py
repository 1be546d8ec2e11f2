"""`hilbed run` on a python-can bus as a user has it: where it is said, what is refused, how it ends."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from threading import Thread

import can
import pytest
import yaml

from tests.can.serial_line import Line, line
from tests.program.hilbed import Ended

SHORT = ("slimane2014/load-torque", "--set", "criteria={}", "--set")
PACED = ("--realtime", "--set", "realtime={tolerance: 100, give_up: 100}")  # on a machine of any speed
QUICK_STOPS = {f"t60{node}82B40600002000000" for node in (1, 2)}


@pytest.fixture
def home(tmp_path: Path) -> dict[str, str]:
    """An environment without python-can's settings; serial adapters need no time to wake up."""
    kept = {key: value for key, value in os.environ.items() if not key.startswith("CAN_")}
    return {**kept, "HOME": str(tmp_path), "CAN_CONFIG": json.dumps({"sleep_after_open": 0})}


@pytest.fixture
def far() -> Iterator[Line]:
    with line() as one:
        yield one


def start(*arguments: str | Path, env: dict[str, str]) -> subprocess.Popen[str]:
    command = [sys.executable, "-m", "hilbed", "run", *map(str, arguments)]
    return subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=env, cwd=env["HOME"]
    )


def run(*arguments: str | Path, env: dict[str, str]) -> Ended:
    process = start(*arguments, env=env)
    out, err = process.communicate(timeout=120)
    return Ended(process.returncode, out, err)


class Reader(Thread):
    """Takes everything off a serial line until it is unplugged."""

    def __init__(self, far: Line) -> None:
        super().__init__(daemon=True)
        self.lines: list[str] = []
        self._far = far
        self.start()

    def run(self) -> None:
        try:
            while True:
                self.lines += self._far.read(1)
        except OSError:
            return


def slcan(message: can.Message) -> str:
    return f"t{message.arbitration_id:03X}{message.dlc}{message.data.hex().upper()}"


def verdict(folder: Path) -> dict[str, object]:
    told: dict[str, object] = json.loads((folder / "verdict.json").read_text())
    return told


def test_over_a_serial_adapter_the_run_is_the_same_and_runs_again(
    far: Line, home: dict[str, str], tmp_path: Path
) -> None:
    reader = Reader(far)
    ended = run(*SHORT, "duration=0.5", "-i", "slcan", "-c", far.path, "--out", "joined", env=home)
    assert ended.status == 0, ended.err
    assert f"slcan {far.path}: " in ended.out
    logged = [slcan(message) for message in can.LogReader(tmp_path / "joined" / "can.log")]
    assert logged == reader.lines[: len(logged)]
    block = yaml.safe_load((tmp_path / "joined" / "scenario.yaml").read_text())["bus"]
    assert (block["interface"], block["channel"], block["bitrate"]) == ("slcan", far.path, 500_000)

    assert run(*SHORT, "duration=0.5", "--record", "none", "--out", "alone", env=home).status == 0
    assert run("joined/scenario.yaml", "--record", "none", "--out", "again", env=home).status == 0
    found = [verdict(tmp_path / name) for name in ("joined", "alone", "again")]
    assert len({one["hash"] for one in found}) == len({one["signals_hash"] for one in found}) == 1
    assert [("adapter" in one) for one in found] == [True, False, True]


def test_an_adapter_that_is_unplugged_ends_the_run_with_7(
    far: Line, home: dict[str, str], tmp_path: Path
) -> None:
    process = start(*SHORT, "duration=8", "-i", "slcan", "-c", far.path, "--out", "run", env=home)
    far.read(600)
    far.unplug()
    out, err = process.communicate(timeout=60)
    assert (process.returncode, "Traceback" in err) == (7, False), err
    told = verdict(tmp_path / "run")
    assert told["passed"] is False
    assert f"slcan {far.path}: lost while" in str(told["reason"])
    assert str(told["reason"]) in out
    assert (tmp_path / "run" / "report.html").is_file()


def test_nobody_who_takes_frames_ends_the_run_with_7_in_real_time(
    far: Line, home: dict[str, str], tmp_path: Path
) -> None:
    """The other end of the line is never read, so its buffer fills."""
    ended = run(*SHORT, "duration=8", *PACED, "-i", "slcan", "-c", far.path, "--out", "run", env=home)
    assert ended.status == 7, ended.err
    assert "lost while sending" in str(verdict(tmp_path / "run")["reason"])


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_stops_the_drives_on_the_bus(
    far: Line, home: dict[str, str], tmp_path: Path, number: signal.Signals
) -> None:
    process = start(*SHORT, "duration=60", *PACED, "-i", "slcan", "-c", far.path, "--out", "run", env=home)
    far.read(300)  # of them a third at boot
    reader = Reader(far)
    process.send_signal(number)
    process.communicate(timeout=60)
    assert process.returncode == 2
    assert signal.Signals(number).name in str(verdict(tmp_path / "run")["reason"])
    assert set(reader.lines) >= QUICK_STOPS
    first = min(reader.lines.index(stop) for stop in QUICK_STOPS)
    targets = [entry for entry in reader.lines[first:] if entry[:4] in ("t201", "t202")]
    assert {entry[5:9] for entry in targets} == {"0200"}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("-i", "sockectan", "-c", "vcan0"), "unknown interface 'sockectan'; python-can knows"),
        (("-c", "vcan0"), "no interface that python-can knows is named by -i, CAN_INTERFACE or ~/.canrc"),
        (("-i", "socketcan"), "socketcan needs a channel, such as -c can0"),
        (("-i", "socketcan", "-c", "nocan7"), "socketcan nocan7 cannot be opened"),
        (("-i", "slcan", "-c", "/dev/nothing"), "there is no such device"),
        (("-i", "virtual", "-c", "x", "-b", "123"), "no bit rate of CiA"),
        (("-b", "fast"), "invalid int value"),
        (("-i", "slcan", "-c", "/dev/null", "-b", "800000"), "slcan /dev/null cannot be opened"),
        (("--set", "bus.interface=sockectan"), "unknown interface 'sockectan'"),
        (("--set", "realtime={overrun: hurry}"), "realtime.overrun"),
    ],
)
def test_what_cannot_be_is_refused_with_4_and_nothing_written(
    arguments: tuple[str, ...], message: str, home: dict[str, str], tmp_path: Path
) -> None:
    ended = run(*SHORT, "duration=0.1", *arguments, env=home)
    assert (ended.status, "Traceback" in ended.err) == (4, False), ended.err
    assert message in ended.err
    assert list(tmp_path.iterdir()) == []


def test_a_bus_is_asked_for_or_the_run_is_simulated(home: dict[str, str], tmp_path: Path) -> None:
    """A file of python-can's says nothing by itself; it fills in what -i or CAN_INTERFACE leave open."""
    (tmp_path / ".canrc").write_text("[default]\ninterface = virtual\nchannel = filed\nbitrate = 250000\n")

    def joined(*arguments: str, **variables: str) -> object:
        quick = ("duration=0.02", "--record", "none", "--out", "run", "--force", "--json")
        ended = run(*SHORT, *quick, *arguments, env={**home, **variables})
        assert ended.status == 0, ended.err
        return json.loads(ended.out).get("adapter", {}).get("name")

    assert joined() is None
    assert joined("-i", "virtual") == "virtual filed"
    assert joined(CAN_INTERFACE="virtual", CAN_CHANNEL="given") == "virtual given"


def test_real_time_is_told_and_drawn(home: dict[str, str], tmp_path: Path) -> None:
    limit = "criteria={missed_deadlines: {max: 0}}"
    scenario = SHORT[0]
    ended = run(scenario, "--set", "duration=0.2", "--set", limit, *PACED, "--out", "run", env=home)
    assert ended.status == 0, ended.err
    assert "missed_deadlines" in ended.out
    assert "0 of 21 deadlines missed" in ended.out
    report = (tmp_path / "run" / "report.html").read_text()
    assert "histogram of the lateness of the cycles" in report
    assert run("run/scenario.yaml", "--record", "none", "--out", "again", env=home).status == 0
    assert "realtime" in verdict(tmp_path / "again")
