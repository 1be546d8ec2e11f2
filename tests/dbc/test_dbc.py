"""The exported DBC: cantools decodes a recorded can.log to what signals.npz says the controller saw."""

from __future__ import annotations

from collections.abc import Iterator
from math import tau
from pathlib import Path
from typing import Any

import can
import cantools
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed.build import BOOT
from hilbed.can.dbc import dbc
from hilbed.can.drive_table import load_table
from hilbed.can.node import Node
from hilbed.clock import SECOND
from tests.program.hilbed import hilbed
from tests.replay.runs import recorded

MIRRORED = load_table("hilbed402").model_copy(
    update={"units": load_table("hilbed402").units.model_copy(update={"polarity": -1, "gear": 2.0})}
)
NODES = (Node("left", 1, load_table("hilbed402")), Node("right", 2, MIRRORED))


@pytest.fixture(scope="module")
def run() -> Path:
    return recorded()


def _decoded(run: Path) -> Iterator[tuple[float, str, dict[str, Any]]]:
    """Yields every frame of the log, decoded: s since the start of the run, message, signals."""
    database = cantools.database.load_file(run / "bus.dbc")
    for message in can.LogReader(run / "can.log"):
        name = database.get_message_by_frame_id(message.arbitration_id).name
        values = database.decode_message(message.arbitration_id, message.data)
        yield message.timestamp - BOOT / SECOND, name, values


@pytest.mark.parametrize("drive", ["left", "right"])
@pytest.mark.parametrize(
    ("signal", "column"),
    [("velocity_actual", "speed_measured"), ("current_actual", "current_measured")],
)
def test_a_decoded_log_says_what_the_signals_say(run: Path, drive: str, signal: str, column: str) -> None:
    said = [
        (t, values[signal])
        for t, name, values in _decoded(run)
        if t > 0 and name.startswith(f"{drive}_tpdo") and signal in values
    ]
    with np.load(run / "signals.npz") as signals:
        t, measured = signals["t"], signals[f"drive/{drive}/{column}"]
    times = np.array([each[0] for each in said])
    latest = np.searchsorted(times, t + 1e-9, side="right") - 1  # the last one that had come by t
    known = latest >= 0
    assert known.sum() >= len(t) - 2
    assert np.isnan(measured[~known]).all()
    decoded = np.array([each[1] for each in said])[latest[known]]
    np.testing.assert_allclose(decoded, measured[known], rtol=1e-12, atol=1e-15)
    assert np.ptp(decoded) > 0.1


def test_every_frame_of_a_log_is_decoded(run: Path) -> None:
    names = {name for _, name, _ in _decoded(run)}
    assert {"sync", "nmt", "left_rpdo1", "left_tpdo3", "right_heartbeat", "left_sdo_answer"} <= names
    boots = [values for t, name, values in _decoded(run) if name == "left_heartbeat" and t < 0]
    assert str(boots[0]["state"]) == "boot-up"


def test_the_position_turns_as_far_as_the_odometry_says(run: Path) -> None:
    turned = {"left": [], "right": []}  # type: dict[str, list[float]]
    for t, name, values in _decoded(run):
        if 0 < t < 3 and "position_actual" in values:  # afterwards the drives are brought to rest
            turned[name.split("_")[0]].append(values["position_actual"])
    with np.load(run / "signals.npz") as signals:
        speeds = [signals[f"drive/{drive}/speed"] for drive in turned]
        dt = signals["t"][1]
    for positions, speed in zip(turned.values(), speeds, strict=True):
        assert positions[-1] - positions[0] == pytest.approx(np.trapezoid(speed, dx=dt), abs=0.1)


@given(velocity=st.integers(-(2**31), 2**31 - 1), position=st.integers(-(2**31), 2**31 - 1))
def test_units_and_mirrored_motors(velocity: int, position: int) -> None:
    database = cantools.database.load_string(dbc(NODES), "dbc")
    codec, second = MIRRORED.codec("tpdo1"), MIRRORED.codec("tpdo2")
    said = database.decode_message(0x182, codec.pack(0x0237, velocity, -5))
    assert said["velocity_actual"] == pytest.approx(-velocity * tau / 66_000 / 2, rel=1e-12)
    assert said["statusword"] == 0x0237
    assert said["torque_actual"] == -5
    said = database.decode_message(0x282, second.pack(position, 500))
    assert said["position_actual"] == pytest.approx(-position * tau / 66_000 / 2, rel=1e-12)
    assert said["current_actual"] == pytest.approx(-0.5 * 3.36)


@given(st.integers(-(2**31), 2**31 - 1), st.integers(0, 0xFFFF))
def test_a_target_goes_both_ways(target: int, word: int) -> None:
    database = cantools.database.load_string(dbc(NODES), "dbc")
    data = load_table("hilbed402").codec("rpdo1").pack(word, target)
    said = database.decode_message(0x201, data)
    assert database.encode_message(0x201, said) == data


def test_comments_lead_to_the_signals() -> None:
    database = cantools.database.load_string(dbc(NODES), "dbc")
    signal = database.get_message_by_name("left_tpdo1").get_signal_by_name("velocity_actual")
    assert signal.comment == "object 606C:00; drive/left/speed_measured of signals.npz"
    assert signal.unit == "rad/s"
    assert database.get_message_by_name("left_tpdo3").cycle_time == 100


def test_the_command_prints_what_the_run_folder_holds(run: Path) -> None:
    ended = hilbed("bus", "dbc", run)
    assert (ended.status, ended.err) == (0, "")
    assert ended.out == (run / "bus.dbc").read_text()


def test_a_plant_without_a_bus_has_no_dbc(tmp_path: Path) -> None:
    ended = hilbed("bus", "dbc", tmp_path)
    assert ended.status == 4
    assert "Traceback" not in ended.err
