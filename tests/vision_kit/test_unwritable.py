"""A folder that cannot be written is told before the first frame is made, not after the last."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.program.hilbed import hilbed


@pytest.mark.parametrize("command", ["frames", "vision"])
def test_a_folder_that_cannot_be_written_ends_with_4(tmp_path: Path, command: str) -> None:
    (tmp_path / "file").touch()
    for out in (tmp_path / "file", tmp_path / "file" / "below", Path("/proc/no/such")):
        ended = hilbed(command, "vision/clean", "-n", "100000", "--out", out)
        assert ended.status == 4
        assert ended.out == ""
        assert f"{out}: " in ended.err
        assert "give another folder with --out" in ended.err
    assert (tmp_path / "file").read_bytes() == b""
