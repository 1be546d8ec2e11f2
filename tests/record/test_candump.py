from __future__ import annotations

import re
from pathlib import Path

import pytest
from can import LogReader
from hypothesis import given
from hypothesis import strategies as st

from hilbed.record.candump import CandumpLog, line
from hilbed.record.disk import RecordError
from hilbed.types import ACK_ERROR, BIT_ERROR, Frame, Transfer
from tests.record.runs import play

BOOT = 2_000_000_000
frames = st.builds(
    lambda low, high, data, extended, remote: Frame(
        high if extended else low, b"" if remote else data, extended, remote
    ),
    st.integers(0, 0x7FF),
    st.integers(0, 0x1FFF_FFFF),
    st.binary(max_size=8),
    st.booleans(),
    st.booleans(),
)


@given(st.lists(st.tuples(st.integers(-BOOT, 10**12), frames), max_size=20))
def test_python_can_reads_back_what_was_written(sent: list[tuple[int, Frame]]) -> None:
    from io import StringIO

    from can.io import CanutilsLogReader

    text = "".join(line(Transfer(0, 0, t, frame, "x"), BOOT, "hilbed") for t, frame in sent)
    for (t, frame), message in zip(sent, CanutilsLogReader(StringIO(text)), strict=True):
        assert message.arbitration_id == frame.id
        assert message.is_extended_id == frame.extended
        assert message.is_remote_frame == frame.remote
        assert bytes(message.data or b"") == frame.data
        assert message.timestamp == pytest.approx((t + BOOT) / 1e9, abs=1.1e-6)
        assert message.channel == "hilbed"


def test_the_file_holds_every_frame_in_the_form_of_candump(tmp_path: Path) -> None:
    path = tmp_path / "can.log"
    play([CandumpLog(path, BOOT)], cycles=20)
    lines = path.read_text().splitlines()
    assert len(lines) == len(list(LogReader(path))) == 43
    assert all(re.fullmatch(r"\(\d+\.\d{6}\) hilbed [0-9A-F]{3}#([0-9A-F]{2}){0,8}", one) for one in lines)
    assert lines[0] == "(1.000234) hilbed 700#01AB"
    assert lines[3] == "(2.000234) hilbed 080#"


@pytest.mark.parametrize(("error", "bits"), [(BIT_ERROR, 0x88), (ACK_ERROR, 0xA0)])
def test_error_frames_are_those_of_linux(error: int, bits: int) -> None:
    """CAN_ERR_FLAG and classes as in linux/can/error.h: protocol 0x8, acknowledge 0x20, bus error 0x80."""
    from io import StringIO

    from can.io import CanutilsLogReader

    text = line(Transfer(0, 0, 5_000, Frame(0x181, b"x"), "x", error), 0, "hilbed")
    name, _, data = text.split()[2].partition("#")
    assert int(name, 16) == 0x2000_0000 | bits
    assert len(bytes.fromhex(data)) == 8
    (message,) = CanutilsLogReader(StringIO(text))
    assert message.is_error_frame
    assert message.timestamp == pytest.approx(5e-6)


def test_a_killed_run_leaves_all_but_the_last_second(tmp_path: Path) -> None:
    path = tmp_path / "can.log"
    play([CandumpLog(path, BOOT)], cycles=301, close=False)
    assert path.read_bytes().endswith(b"\n")
    assert list(LogReader(path))[-1].timestamp >= 2 + 2.0


def test_a_full_disk_is_told() -> None:
    with pytest.raises(RecordError, match="No space left"):
        play([CandumpLog(Path("/dev/full"))], cycles=301)
