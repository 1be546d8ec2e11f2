"""A replay of an unchanged program is identical to the bit; a change shows where it begins to matter."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed.build import BOOT
from hilbed.clock import SECOND
from hilbed.record.candump import line
from hilbed.replay.candump import parse
from hilbed.replay.command import perform, replay
from hilbed.replay.differences import compared, differences
from hilbed.replay.recording import exact, read_recording
from hilbed.types import Frame, Received, ScenarioError, Transfer
from tests.program.hilbed import hilbed
from tests.replay.runs import recorded


@pytest.mark.parametrize(
    "settings",
    [
        (),
        ("bus.bitrate=800000",),  # whose bits are no whole microseconds
        ("bus.bitrate=250000", "controller=open_loop", "estimator=odometry"),
        ("sensors.camera.identity=anonymous", "sensors.camera.noise=0.002", "sensors.camera.loss=0.2"),
        (
            "disturbances=[{kind: slip_patch, corner: [0, -1], opposite: [1, 1], friction: 0.1}, "
            "{kind: command_noise, start: 0.3, size: [0.05, 0.2]}]",
            "plant.start_std=[0.05, 0.05, 0.02]",
        ),
    ],
)
def test_an_unchanged_program_gives_the_same_to_the_bit(settings: tuple[str, ...]) -> None:
    recording = read_recording(recorded(*settings))
    replayed = perform(recording)
    assert replayed.reason == ""
    assert differences(recording.signals, replayed.signals) == []
    for name in ("odometry", "estimate", "covariance", "command", "drive/left/speed_measured"):
        assert replayed.signals[name].tobytes() == recording.signals[name].tobytes()
    assert {"drive/right/current_measured", "nis/value"} <= {*compared(replayed.signals)} | {"nis/value"}


def test_another_estimator_differs_from_the_first_reading_on() -> None:
    recording = read_recording(recorded(), ["estimator.azimuth.std=0.05"])
    found = {one.column: one for one in differences(recording.signals, perform(recording).signals)}
    delivered = recording.signals["azimuth/delivered"][0]
    assert found["covariance"].first == pytest.approx(delivered, abs=recording.loaded.scenario.period)
    assert found["covariance"].first >= delivered - 1e-9
    assert found["estimate"].largest > 0
    assert "odometry" not in found
    assert "drive/left/speed_measured" not in found


def _edited(run: Path, edit: Callable[[list[str]], list[str]]) -> None:
    log = run / "can.log"
    log.write_text("\n".join(edit(log.read_text().splitlines())) + "\n")


def test_a_frame_that_was_changed_shows_where_it_acts(run: Path, capsys: pytest.CaptureFixture[str]) -> None:
    changed: list[float] = []

    def edit(lines: list[str]) -> list[str]:
        """Moves the left wheel's position by 100 counts in the first frame after t = 1.5 s."""
        for k, text in enumerate(lines):
            received = parse(text)
            if received is not None and received.frame.id == 0x281 and received.t > BOOT + 1.5 * SECOND:
                position = int.from_bytes(received.frame.data[:4], "little", signed=True) + 100
                data = position.to_bytes(4, "little", signed=True) + received.frame.data[4:]
                lines[k] = f"{text.split('#')[0]}#{data.hex().upper()}"
                changed.append((received.t - BOOT) / SECOND)
                return lines
        raise AssertionError

    _edited(run, edit)
    assert replay(run, [], as_json=True) == 1
    told = json.loads(capsys.readouterr().out)
    assert not told["identical"]
    first = told["differences"]["odometry"]["first"]
    assert changed[0] <= first <= changed[0] + 0.01
    assert "drive/left/speed_measured" not in told["differences"]
    # 100 counts of 66 000 a turn of a wheel of 0.1 m, half of it at the axle's middle
    assert told["differences"]["odometry"]["largest"] >= 0.5 * 100 / 66_000 * 2 * np.pi * 0.1


def test_a_drive_cut_out_of_the_log_ends_the_replay_early(run: Path) -> None:
    def edit(lines: list[str]) -> list[str]:
        left = (" 181#", " 281#", " 381#")
        return [text for text in lines if float(text[1:9]) < 2.0 or not any(name in text for name in left)]

    _edited(run, edit)
    recording = read_recording(run)
    replayed = perform(recording)
    assert "drive left (node 1) has been silent" in replayed.reason
    rows = {one.column: one for one in differences(recording.signals, replayed.signals)}
    assert rows["estimate"].largest == np.inf


MICRO = st.integers(-BOOT, 10**11)


@given(st.lists(st.tuples(MICRO, st.sampled_from([0x80, 0x181, 0x281])), max_size=40))
def test_times_are_exact_to_the_nanosecond(sent: list[tuple[int, int]]) -> None:
    sent.sort(key=lambda each: each[0])
    signals = {
        "bus/t": np.array([t * 1e-9 for t, _ in sent]),
        "bus/id": np.array([number for _, number in sent], dtype=np.int64),
    }
    lines = [line(Transfer(0, 0, t, Frame(number), "a"), BOOT, "hilbed") for t, number in sent]
    log = [received for text in lines if (received := parse(text)) is not None]
    assert exact(log, signals) == [Received(t, Frame(number)) for t, number in sent]


def test_a_frame_put_into_the_log_keeps_its_microseconds() -> None:
    log = [Received(BOOT + 5_000, Frame(0x181))]
    assert exact(log, {}) == [Received(5_000, Frame(0x181))]


def test_broken_lines_end_with_4_and_their_place(run: Path) -> None:
    _edited(run, lambda lines: [*lines[:10], "(1.0) broken", *lines[10:]])
    ended = hilbed("replay", run)
    assert ended.status == 4
    assert f"{run}/can.log:11: " in ended.err
    assert "Traceback" not in ended.err
    assert ended.out == ""


def test_the_command_tells_that_nothing_differs(run: Path) -> None:
    ended = hilbed("replay", run)
    assert (ended.status, ended.err) == (0, "")
    assert ended.out.startswith("301 cycles")
    assert ended.out.endswith("identical\n")


@pytest.mark.parametrize("name", ["scenario.yaml", "can.log", "signals.npz"])
def test_a_folder_that_lacks_something_is_told(run: Path, name: str) -> None:
    (run / name).unlink()
    with pytest.raises(ScenarioError, match=name):
        read_recording(run)


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 broken", b"hello"])
def test_signals_that_are_none_are_told(run: Path, content: bytes) -> None:
    (run / "signals.npz").write_bytes(content)
    with pytest.raises(ScenarioError, match=r"signals\.npz"):
        read_recording(run)


def test_signals_of_an_older_bench_are_told(run: Path) -> None:
    signals: dict[str, Any] = dict(np.load(run / "signals.npz"))
    del signals["azimuth/std"]
    np.savez(run / "signals.npz", **signals)
    with pytest.raises(ScenarioError, match="azimuth/std"):
        perform(read_recording(run))


def test_a_log_without_frames_is_told(run: Path) -> None:
    (run / "can.log").write_text("")
    with pytest.raises(ScenarioError, match=r"can\.log holds no frame"):
        read_recording(run)


def test_no_folder_is_told(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match="not a run folder"):
        read_recording(tmp_path / "nowhere")
