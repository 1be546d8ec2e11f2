"""However a command ends, its exit status says so, and what it wrote stays readable."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.program.hilbed import hilbed

HILBED = (sys.executable, "-m", "hilbed")
LINE = ("slimane2014/load-torque", "--set", "duration=2", "--set", "criteria={}")


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A file system with room for a megabyte."""
    place = tmp_path / "disk"
    place.mkdir()
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=1m", "tmpfs", place], capture_output=True, check=False
    )
    if mounted.returncode:
        pytest.skip("mounting a small file system needs root")
    yield place
    subprocess.run(["umount", place], check=True)


def test_a_full_disk_ends_the_run_with_3_and_its_name_and_keeps_the_logs(small_disk: Path) -> None:
    import can
    from mcap.reader import make_reader

    out = small_disk / "run"
    ended = hilbed("run", "slimane2014/load-torque", "--set", "duration=100", "--out", out, "--json")
    assert ended.status == 3, ended.err
    told = json.loads(ended.out)
    assert told == json.loads((out / "verdict.json").read_text())
    assert told["passed"] is False
    assert told["reason"].startswith("t = ")
    assert told["reason"].endswith("No space left on device")
    assert 0.5 < told["sim_time"] < 90, "soon after it is full"
    frames = list(can.LogReader(out / "can.log"))
    with (out / "log.mcap").open("rb") as stream:
        last = [message.log_time for _, _, message in make_reader(stream).iter_messages()][-1]
    assert min(last / 1e9, frames[-1].timestamp) > 3
    assert {entry.name for entry in out.iterdir()} <= {
        "scenario.yaml", "can.log", "bus.dbc", "log.mcap", "verdict.json",
    }  # fmt: skip


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_before_the_run_ends_with_2_and_nothing_written(
    tmp_path: Path, number: signal.Signals
) -> None:
    """The scenario is a big one to read, so that the signal comes while it is read."""
    beacons = "".join(f"    - {{at: [{k % 20}, 1]}}\n" for k in range(15_000))
    text = f"duration: 1\nplant:\n  kind: bullet\n  beacons:\n{beacons}estimator: odometry\n"
    (tmp_path / "long.yaml").write_text(text)
    process = subprocess.Popen(
        [*HILBED, "run", "long.yaml", "--out", "run"], stderr=subprocess.PIPE, text=True, cwd=tmp_path
    )
    time.sleep(1.0)
    process.send_signal(number)
    _, err = process.communicate(timeout=60)
    assert (process.returncode, err) == (2, "interrupted\n")
    assert not (tmp_path / "run").exists()


def test_a_reader_that_goes_away_changes_neither_status_nor_folder(tmp_path: Path) -> None:
    """The limit is one that nothing meets."""
    limit = ("--set", "criteria={duty_max: {max: 0}}")
    command = [*HILBED, "run", *LINE, *limit, "--out", str(tmp_path / "run"), "--json"]
    read, write = os.pipe()
    os.close(read)
    ended = subprocess.run(command, stdout=write, stderr=subprocess.PIPE, check=False)
    os.close(write)
    assert (ended.returncode, ended.stderr) == (1, b"")
    assert (tmp_path / "run" / "report.html").is_file()


def test_closed_streams_do_not_get_into_the_logs(tmp_path: Path) -> None:
    script = f'exec {" ".join(HILBED)} "$@" >&- 2>&- <&-'
    ended = subprocess.run(["sh", "-c", script, "sh", "run", *LINE, "--out", tmp_path / "run"], check=False)
    assert ended.returncode == 0
    lines = (tmp_path / "run" / "can.log").read_text().splitlines()
    assert all(line.startswith("(") for line in lines)


def test_a_full_disk_behind_standard_output_is_no_traceback() -> None:
    with Path("/dev/full").open("w") as full:
        ended = subprocess.run([*HILBED, "list"], stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert (ended.returncode, ended.stderr) == (3, "output: No space left on device\n")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_ends_a_sweep_with_all_its_processes(tmp_path: Path, number: signal.Signals) -> None:
    """Every process holds the pipe of standard error, so that its end is that of the last of them."""
    command = [*HILBED, "sweep", "demo", "--seeds", "1..100", "--jobs", "2", "--set", "duration=600"]
    process = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=tmp_path
    )
    time.sleep(4.0)
    process.send_signal(number)
    out, err = process.communicate(timeout=30)
    assert (process.returncode, out, err) == (2, "", "interrupted\n")
