"""`hilbed run`: folder, verdict, hashes and exit statuses."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.program.hilbed import hilbed

# Too short for odometry to go astray.
SHORT = ("--set", "duration=1.5", "--set", "criteria.odometry_over_estimate.min=0")
CONTENT = {
    "scenario.yaml", "signals.npz", "log.mcap", "can.log", "bus.dbc", "verdict.json", "report.html", "frames",
    "attribution.json",
}  # fmt: skip


def verdict(folder: Path) -> dict[str, Any]:
    content: dict[str, Any] = json.loads((folder / "verdict.json").read_text())
    return content


@pytest.fixture(scope="module")
def demo(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runs") / "demo"
    ended = hilbed("run", "demo", *SHORT, "--out", folder)
    assert ended.status == 0, ended.err
    assert "demo seed 1: passed" in ended.out
    assert str(folder / "report.html") in ended.out
    return folder


def test_the_folder_holds_what_the_contract_names(demo: Path) -> None:
    assert {entry.name for entry in demo.iterdir()} == CONTENT


def test_the_signals_are_those_of_the_contract(demo: Path) -> None:
    signals = np.load(demo / "signals.npz")
    rows, ticks = 151, 1501
    shapes = {
        "t": (rows,), "truth": (rows, 3), "estimate": (rows, 3), "odometry": (rows, 3),
        "reference": (rows, 3), "covariance": (rows, 3, 3), "command": (rows, 2), "tick/t": (ticks,),
    }  # fmt: skip
    for drive in ("left", "right"):
        plant = ("speed", "current", "slip", "load_torque", "torque", "speed_ref", "duty")
        shapes |= {
            f"drive/{drive}/{name}": (rows,) for name in (*plant, "speed_measured", "current_measured")
        }
        shapes |= {f"tick/drive/{drive}/{name}": (ticks,) for name in plant}
    assert {name: signals[name].shape for name in shapes} == shapes
    assert signals["t"] == pytest.approx(0.01 * np.arange(rows))
    count = len(signals["azimuth/t"])
    assert count > 20
    assert all(
        len(signals[f"azimuth/{name}"]) == count for name in ("delivered", "beacon", "measured", "true")
    )
    assert np.all(signals["azimuth/delivered"] > signals["azimuth/t"])
    assert set(signals["nis/accepted"].tolist()) <= {True, False}
    assert "landmark_distance" not in signals
    speed = signals["tick/drive/left/speed"]
    assert np.array_equal(signals["drive/left/speed"], speed[::10])


def test_the_verdict_is_that_of_the_contract(demo: Path) -> None:
    content = verdict(demo)
    assert list(content)[:4] == ["scenario", "seed", "passed", "reason"]
    assert content["sim_time"] == 1.5
    assert content["real_time_factor"] == pytest.approx(1.5 / content["wall_time"])
    parts = {"physics", "render", "vision", "bus", "drives", "estimator", "controller", "record"}
    assert set(content["cost"]) == parts
    assert all(spent > 0 for spent in content["cost"].values())
    assert content["criteria"]["cross_track_rms"]["limit"] == 0.06
    assert len(content["hash"]) == len(content["signals_hash"]) == 64


def test_every_frame_of_the_bus_is_in_the_log(demo: Path) -> None:
    import can

    frames = list(can.LogReader(demo / "can.log"))
    syncs = [frame.timestamp for frame in frames if frame.arbitration_id == 0x80]
    assert len([t for t in syncs if t < 2.5]) == 150  # the others belong to the stop
    assert syncs[0] == pytest.approx(1.0, abs=0.001)
    assert {0x701, 0x702, 0x581, 0x601, 0x181, 0x282} <= {frame.arbitration_id for frame in frames}


def test_the_resolved_scenario_gives_the_same_hash_from_anywhere(demo: Path, tmp_path: Path) -> None:
    moved = tmp_path / "copy.yaml"
    moved.write_text((demo / "scenario.yaml").read_text())
    ended = hilbed("run", moved, "--record", "none", "--json", "--out", tmp_path / "again", cwd=tmp_path)
    assert ended.status == 0, ended.err
    again = json.loads(ended.out)
    assert (again["hash"], again["signals_hash"]) == (verdict(demo)["hash"], verdict(demo)["signals_hash"])


@pytest.mark.parametrize("level", ["signals", "none"])
def test_what_is_recorded_does_not_change_the_run(demo: Path, tmp_path: Path, level: str) -> None:
    ended = hilbed("run", "demo", *SHORT, "--record", level, "--out", tmp_path / "run")
    assert ended.status == 0, ended.err
    assert verdict(tmp_path / "run")["hash"] == verdict(demo)["hash"]
    logs = {"log.mcap", "can.log", "bus.dbc", "frames"}
    absent = logs if level == "signals" else logs | {"signals.npz", "report.html", "attribution.json"}
    assert {entry.name for entry in (tmp_path / "run").iterdir()} == CONTENT - absent


def test_another_seed_is_another_run(tmp_path: Path) -> None:
    settings = ("--set", "disturbances.0.spread=0.01", *SHORT, "--record", "none")
    hashes = set()
    for seed in ("3", "4"):
        hilbed("run", "demo", *settings, "--seed", seed, "--out", tmp_path / seed)
        hashes.add(verdict(tmp_path / seed)["hash"])
    assert len(hashes) == 2


def test_json_is_all_that_is_printed(tmp_path: Path) -> None:
    ended = hilbed(
        "run", "slimane2014/load-torque", *SHORT, "--json", "--out", tmp_path / "run", "--record", "none"
    )
    assert json.loads(ended.out) == verdict(tmp_path / "run")
    assert ended.err == ""


def test_a_criterion_that_is_not_met_ends_with_1(tmp_path: Path) -> None:
    limit = ("--set", "criteria.cross_track_rms.max=0.000001")
    ended = hilbed("run", "demo", *SHORT, *limit, "--out", tmp_path / "run", "--record", "none")
    assert ended.status == 1
    assert "FAIL" in ended.out
    assert "cross_track_rms" in verdict(tmp_path / "run")["reason"]


def test_an_existing_run_is_kept_unless_forced(demo: Path) -> None:
    before = (demo / "verdict.json").read_bytes()
    ended = hilbed("run", "demo", *SHORT, "--out", demo)
    assert (ended.status, ended.out) == (4, "")
    assert "--force" in ended.err
    assert (demo / "verdict.json").read_bytes() == before


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_stops_the_drives_and_closes_the_logs(tmp_path: Path, number: signal.Signals) -> None:
    folder = tmp_path / "run"
    command = [sys.executable, "-m", "hilbed", "run", "demo", "--set", "duration=600", "--out", str(folder)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    log = folder / "can.log"
    while process.poll() is None and not (log.is_file() and log.stat().st_size > 50_000):
        pass
    process.send_signal(number)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 2, err
    assert number.name in verdict(folder)["reason"]
    assert verdict(folder)["passed"] is False
    assert "report.html" in out
    quick_stop = [line for line in log.read_text().splitlines() if "601#2B40600002" in line]
    assert len(quick_stop) == 1
    speed_at_the_end = [line.split("#")[1] for line in log.read_text().splitlines() if " 181#" in line][-1]
    assert speed_at_the_end  # the log is whole to the last line


def test_a_robot_that_leaves_the_world_ends_with_3_and_keeps_its_logs(tmp_path: Path) -> None:
    away = (
        "--set",
        "plant.arena=9",
        "--set",
        "disturbances=[{kind: push, start: 0.5, size: [-900, 0], length: 1}]",
    )
    ended = hilbed("run", "demo", "--set", "duration=6", *away, "--out", tmp_path / "run")
    assert ended.status == 3
    content = verdict(tmp_path / "run")
    assert content["passed"] is False
    assert "t = " in content["reason"]
    assert "robot" in content["reason"]
    assert len(np.load(tmp_path / "run" / "signals.npz")["t"]) > 50
    assert (tmp_path / "run" / "report.html").is_file()


def test_a_drive_that_refuses_its_configuration_ends_with_7(tmp_path: Path) -> None:
    gains = ("--set", "nodes.left.gains={kp: 1.0e+6}")
    ended = hilbed("run", "demo", *SHORT, *gains, "--out", tmp_path / "run")
    assert ended.status == 7
    content = verdict(tmp_path / "run")
    assert content["passed"] is False
    assert all(word in content["reason"] for word in ("left", "2010", "06090031"))
    assert content["metrics"]["estimate_position_rms"] is None
