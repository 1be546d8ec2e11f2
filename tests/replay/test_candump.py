"""candump -L lines: python-can reads the same, what was written comes back, broken ones are told by line."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import can
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed.record.candump import line
from hilbed.replay.candump import parse, read_log
from hilbed.types import Frame, Received, ScenarioError, Transfer

data = st.binary(max_size=8)
standard = st.tuples(st.integers(0, 0x7FF), data, st.just(False), st.just(False)).map(Frame._make)
extended = st.tuples(st.integers(0, 0x1FFFFFFF), data, st.just(True), st.just(False)).map(Frame._make)
remote = st.tuples(st.integers(0, 0x7FF), st.just(b""), st.just(False), st.just(True)).map(Frame._make)
MICROSECONDS = st.integers(0, 10**13).map(lambda number: number * 1000)


@given(st.lists(st.tuples(MICROSECONDS, standard | extended | remote), max_size=20))
def test_what_was_recorded_comes_back(sent: list[tuple[int, Frame]]) -> None:
    lines = [line(Transfer(0, 0, t, frame, "a"), 0, "hilbed") for t, frame in sent]
    assert [parse(text) for text in lines] == [Received(*each) for each in sent]


def test_python_can_reads_and_writes_the_same(tmp_path: Path) -> None:
    path = tmp_path / "log.log"
    with can.Logger(str(path)) as logger:
        logger(can.Message(1.5, 0x181, False, data=b"\x01\x02", channel="can0"))
        logger(can.Message(2.25, 0x1FFE0001, True, data=b"", channel="can0"))
        logger(can.Message(3.0, 0x182, False, is_remote_frame=True, channel="can0"))
        logger(can.Message(4.0, 0, True, is_error_frame=True, channel="can0"))
    assert read_log(path) == [
        Received(1_500_000_000, Frame(0x181, b"\x01\x02")),
        Received(2_250_000_000, Frame(0x1FFE0001, b"", True)),
        Received(3_000_000_000, Frame(0x182, b"", False, True)),
    ]


def test_the_length_a_remote_frame_asks_for() -> None:
    assert parse("(1.000000) can0 182#R4") == Received(1_000_000_000, Frame(0x182, bytes(4), False, True))


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("hello", "candump -L"),
        ("(1.000000) can0 18#00", "3 nor 8"),
        ("(1.000000) can0 800#00", "larger"),
        ("(1.000000) can0 181#0", "data"),
        ("(1.000000) can0 181#001122334455667788", "data"),
        ("(1.000000) can0 181##1001122", "FD"),
        ("(1.000000) can0 181#R9", "remote"),
        ("(1.0000) can0", "candump -L"),
        ("(1e3) can0 181#00", "candump -L"),
        ("(1.000000) can0 181#zz", "data"),
    ],
)
def test_a_broken_line_is_refused_with_a_reason(text: str, why: str) -> None:
    with pytest.raises(ValueError, match=why):
        parse(text)


@given(st.text(max_size=40))
def test_no_line_breaks_the_parser(text: str) -> None:
    with suppress(ValueError):
        parse(text)


def test_every_broken_line_is_told_with_its_number_and_content(tmp_path: Path) -> None:
    path = tmp_path / "can.log"
    path.write_text("(1.000000) can0 181#00\nnonsense\n\n(2.000000) can0 181#0\n")
    with pytest.raises(ScenarioError) as told:
        read_log(path)
    second, fourth = str(told.value).splitlines()
    assert second.startswith(f"{path}:2: ")
    assert "'nonsense'" in second
    assert fourth.startswith(f"{path}:4: ")


def test_a_file_of_nonsense_is_told_in_short(tmp_path: Path) -> None:
    path = tmp_path / "can.log"
    path.write_bytes(b"\xff\x00\n" * 5000)
    with pytest.raises(ScenarioError, match="and 4980 more"):
        read_log(path)
