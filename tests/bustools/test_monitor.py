"""Frames in words: by table, by DBC, in a terminal and in a pipe."""

from __future__ import annotations

from argparse import ArgumentParser
from io import StringIO
from pathlib import Path

import can
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed.bustools.decoder import Decoder, read_dbc
from hilbed.bustools.monitor import Lines, Screen, monitor
from hilbed.bustools.options import add_tools, bus
from hilbed.can.dbc import database, dbc
from hilbed.can.drive_table import load_table
from hilbed.can.node import Node
from hilbed.clock import MILLISECOND
from hilbed.types import Frame, Received, ScenarioError
from tests.bustools.fake import live

TABLE = load_table("hilbed402")
BY_TABLE = Decoder(database([]), TABLE)
BY_DRIVES = Decoder(database([Node("left", 1, TABLE)]))
MOVING = Frame(0x181, TABLE.codec("tpdo1").pack(0x0237, 10504, -20))  # 10504 counts/s: 1 rad/s

frames = st.builds(
    lambda identifier, data, extended, remote: Frame(
        identifier if extended else identifier & 0x7FF, data, extended, remote
    ),
    st.integers(0, 0x1FFFFFFF) | st.integers(0, 0x7FF),
    st.binary(max_size=8),
    st.booleans(),
    st.booleans(),
)


def test_a_drive_by_its_name() -> None:
    name, content = BY_DRIVES.decode(MOVING)
    assert name == "left_tpdo1"
    assert content == (
        "statusword=0237 (operation enabled)  velocity_actual=0.99998 rad/s  torque_actual=-20"
    )


def test_any_node_by_a_table() -> None:
    assert BY_TABLE.decode(MOVING._replace(id=0x187)).name == "node7_tpdo1"
    assert BY_TABLE.decode(Frame(0x707, b"\x05")) == ("node7_heartbeat", "state=operational")
    assert "code=3220 (DC link undervoltage)" in BY_TABLE.decode(Frame(0x87, b"\x20\x32" + bytes(6))).content
    assert BY_TABLE.decode(Frame(0x80)) == ("sync", "")
    assert BY_TABLE.decode(Frame(0, b"\x01\x00")).content == "command=start  node=0"
    sdo = BY_TABLE.decode(Frame(0x607, bytes.fromhex("4041600000000000")))
    assert sdo == ("node7_sdo_request", "command=40  index=6041  subindex=00  data=00000000")


def test_a_stranger_is_shown_raw() -> None:
    assert BY_DRIVES.decode(Frame(0x1AB, b"\x01\xff")) == ("1AB", "01 FF")
    assert BY_TABLE.decode(Frame(0x12345, b"", True)) == ("00012345", "")


def test_a_short_frame_is_told() -> None:
    assert "2 of 8 bytes" in BY_DRIVES.decode(MOVING._replace(data=b"\x37\x02")).content


@given(frames)
def test_a_frame_of_any_content_is_survived(frame: Frame) -> None:
    for decoder in (BY_TABLE, BY_DRIVES):
        assert decoder.decode(frame).name


def test_lines_for_a_pipe() -> None:
    out = StringIO()
    source = live([MOVING, Frame(0x1AB)])
    monitor(source, Lines(BY_DRIVES, out), lambda: not source.adapter.coming, None)
    first, second = out.getvalue().splitlines()
    assert first.split()[1] == "left_tpdo1"
    assert second.split()[1:] == ["1AB"]
    assert float(first.split()[0]) <= float(second.split()[0])


def test_a_screen_shows_the_last_of_each_with_its_rate_and_fits() -> None:
    out = StringIO()
    screen = Screen(BY_DRIVES, out, lambda: (60, 5))
    for k in range(30):
        screen.take(Received(k * 10 * MILLISECOND, MOVING._replace(data=MOVING.data[:2] + bytes((k,)) * 6)))
        for identifier in range(0x400, 0x410):
            screen.take(Received(k * 10 * MILLISECOND, Frame(identifier)))
    screen.draw(300 * MILLISECOND)
    drawn = out.getvalue().split("\033[H")[-1].split("\n")
    assert len(drawn) == 5  # four lines, and what clears the rest
    assert drawn[0].startswith("0.3 s, 510 frames")
    assert drawn[1].split()[:2] == ["left_tpdo1", "100.0/s"]
    assert all(len(line.removesuffix("\033[K")) <= 60 for line in drawn[:-1])


def test_it_draws_ten_times_a_second() -> None:
    out = StringIO()
    screen = Screen(BY_DRIVES, out, lambda: (80, 24))
    for t in range(0, 1000 * MILLISECOND, 10 * MILLISECOND):
        screen.tick(t)
    assert out.getvalue().count("\033[H") == 10


def _command(*arguments: str) -> int:
    parser = ArgumentParser()
    add_tools(parser)
    return bus(parser.parse_args(["monitor", "-i", "virtual", "-c", "seen", *arguments]))


def test_the_command_ends_by_itself_and_says_nothing_to_the_bus(capsys: pytest.CaptureFixture[str]) -> None:
    with can.Bus(interface="virtual", channel="seen") as other:
        assert _command("--for", "0.02") == 0
        assert other.recv(0) is None
    assert capsys.readouterr().out == ""


def test_a_dbc_of_somebody_else(tmp_path: Path) -> None:
    path = tmp_path / "theirs.dbc"
    path.write_text(dbc([Node("wheel", 1, TABLE)]))
    assert Decoder(read_dbc(path)).decode(MOVING).name == "wheel_tpdo1"


@pytest.mark.parametrize("name", ["none.dbc", "broken.dbc", "notes.txt"])
def test_a_file_that_is_no_dbc_is_told(tmp_path: Path, name: str) -> None:
    if not name.startswith("none"):
        (tmp_path / name).write_text("BO_ what?")
    with pytest.raises(ScenarioError, match=name):
        read_dbc(tmp_path / name)
    with pytest.raises(ScenarioError, match=name):
        _command("--dbc", str(tmp_path / name))


@pytest.mark.parametrize(
    "arguments",
    [("--drive", "nonsense"), ("--run", "nonsense"), ("--for", "-1"), ("--for", "nan"), ("--for", "1e99")],
)
def test_bad_options_are_told(arguments: tuple[str, ...]) -> None:
    with pytest.raises(ScenarioError):
        _command(*arguments)
