"""Logs that another process writes: the same to the bit, nothing lost, nobody left behind."""

from __future__ import annotations

import io
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from time import sleep

import numpy as np
import pytest
from mcap.reader import make_reader

from hilbed.cost import Cost
from hilbed.record.disk import RecordError
from hilbed.record.logs import Plan, open_logs
from hilbed.record.mcap import Setting
from hilbed.record.parcel import packed, receive
from hilbed.record.remote import RemoteLogs
from hilbed.record.row import Batch
from hilbed.scene import BeaconSpec
from hilbed.types import Nanos
from tests.record.runs import play

BOOT: Nanos = 2_000_000_000
SETTING = Setting([BeaconSpec(at=(1.0, 2.0), colour="blue")], [(0.0, 0.0)], 0.2, [(5, "bump")], "seed: 1\n")


class Keeping:
    """A sink that keeps copies of its batches, as the journal empties theirs."""

    def __init__(self) -> None:
        self.batches: list[Batch] = []

    def take(self, batch: Batch) -> None:
        self.batches.append(Batch(*map(list, batch)))

    def close(self) -> None:
        pass


def plan(folder: Path) -> Plan:
    folder.mkdir()
    return Plan(folder, BOOT, SETTING, True)


def content(folder: Path) -> dict[str, bytes]:
    return {str(file.relative_to(folder)): file.read_bytes() for file in folder.rglob("*") if file.is_file()}


def until(happened: Callable[[], bool]) -> bool:
    for _ in range(400):
        if happened():
            return True
        sleep(0.05)
    return False


def test_a_batch_comes_out_of_a_stream_as_it_went_in() -> None:
    sink = Keeping()
    play([sink], cycles=151)
    sent = b"".join(bytes(piece) for batch in sink.batches for piece in packed(batch))
    stream = io.BytesIO(sent)
    for batch in sink.batches:
        found = receive(stream)
        assert found is not None
        for one, other in zip(found, batch, strict=True):
            np.testing.assert_equal(one, other)
            assert [type(entry) for entry in one] == [type(entry) for entry in other]
    assert receive(stream) is None
    for length in (3, 10, len(sent) // 2):
        cut = io.BytesIO(sent[:length])
        while receive(cut) is not None:
            pass


def test_the_logs_are_the_same_to_the_bit(tmp_path: Path) -> None:
    cost = Cost()
    play(open_logs(plan(tmp_path / "here")))
    play([RemoteLogs(plan(tmp_path / "there"), cost)])
    here = content(tmp_path / "here")
    assert {"can.log", "log.mcap", "frames/frames.jsonl"} < set(here)
    assert content(tmp_path / "there") == here
    assert cost.record == cost.beside["record"] > 0.0


def test_what_cannot_be_written_is_told_with_the_next_batch(tmp_path: Path) -> None:
    broken = plan(tmp_path / "run")
    (broken.folder / "can.log").symlink_to("/dev/full")
    logs = RemoteLogs(broken, Cost())
    with pytest.raises(RecordError, match=r"can\.log: No space left on device"):
        play([logs], cycles=20_000)
    assert not Path(f"/proc/{logs.pid}").exists()
    with (broken.folder / "log.mcap").open("rb") as stream:
        assert make_reader(stream).get_summary() is not None, "the other log is a whole one"


def test_a_folder_that_is_gone_is_told_at_the_latest_at_the_end(tmp_path: Path) -> None:
    logs = RemoteLogs(Plan(tmp_path / "gone", BOOT, SETTING, True), Cost())
    with pytest.raises(RecordError, match=r"log\.mcap: No such file or directory"):
        play([logs], cycles=2)


def test_a_process_that_was_killed_ends_the_run(tmp_path: Path) -> None:
    logs = RemoteLogs(plan(tmp_path / "run"), Cost())
    os.kill(logs.pid, signal.SIGKILL)
    with pytest.raises(RecordError, match="has ended with -9"):
        play([logs])


def test_ctrl_c_and_sigterm_do_not_end_it(tmp_path: Path) -> None:
    logs = RemoteLogs(plan(tmp_path / "run"), Cost())
    journal = play([logs], cycles=60, close=False)
    assert until((tmp_path / "run" / "can.log").exists)
    os.kill(logs.pid, signal.SIGTERM)
    os.kill(logs.pid, signal.SIGINT)
    journal.close()
    assert (tmp_path / "run" / "can.log").read_text().count("\n") == 3 + 2 * 60


def test_nobody_is_left_when_the_logs_are_forgotten(tmp_path: Path) -> None:
    logs = RemoteLogs(plan(tmp_path / "run"), Cost())
    pid = logs.pid
    del logs
    assert not Path(f"/proc/{pid}").exists()


KILLED = """
import os, signal, sys, time
from pathlib import Path
from tests.record.test_remote import BOOT, SETTING
from hilbed.cost import Cost
from hilbed.record.logs import Plan
from hilbed.record.remote import RemoteLogs
from tests.record.runs import play
folder = Path(sys.argv[1])

class Slowly(RemoteLogs):
    def take(self, batch):
        super().take(batch)
        time.sleep(0.5)

logs = Slowly(Plan(folder, BOOT, SETTING, True), Cost())
while not (folder / "can.log").exists():
    time.sleep(0.01)
play([logs], cycles=251, close=False)
os.kill(os.getpid(), signal.SIGKILL)
"""


def test_when_the_bench_is_killed_the_logs_are_ended_properly(tmp_path: Path) -> None:
    folder = plan(tmp_path / "run").folder
    ended = subprocess.run([sys.executable, "-c", KILLED, folder], check=False, timeout=60)
    assert ended.returncode == -signal.SIGKILL
    log = folder / "log.mcap"

    def whole() -> bool:
        with log.open("rb") as stream:
            return make_reader(stream).get_summary() is not None

    assert until(whole)
    with log.open("rb") as stream:
        cycles = [message.log_time for _, _, message in make_reader(stream).iter_messages(["/cycle"])]
    assert cycles[-1] - BOOT >= 1_500_000_000, "all but the last second"
