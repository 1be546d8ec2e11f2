from __future__ import annotations

import errno
from pathlib import Path

import pytest

from hilbed.record.disk import GrowingFile, RecordError


class Small:
    """A file on a disk with room for ten bytes."""

    def __init__(self, path: Path) -> None:
        self.file = path.open("wb", buffering=0)
        self.closed = False

    def write(self, data: memoryview) -> int:
        room = 10 - self.file.tell()
        if room <= 0:
            raise OSError(errno.ENOSPC, "No space left on device")
        return self.file.write(data[:room])

    def seek(self, offset: int) -> int:
        return self.file.seek(offset)

    def truncate(self, size: int) -> int:
        return self.file.truncate(size)

    def close(self) -> None:
        self.file.close()
        self.closed = True


def test_a_piece_that_does_not_fit_is_taken_back(tmp_path: Path) -> None:
    path = tmp_path / "log"
    file = GrowingFile(path)
    file._file = Small(path)  # type: ignore[assignment]
    for piece in (b"first\n", b"second\n", b"third\n"):
        file.write(piece)
        file.flush()
    with pytest.raises(RecordError, match=r"log: No space left on device"):
        file.check()
    with pytest.raises(RecordError):
        file.close()
    assert path.read_bytes() == b"first\n"


def test_the_tail_stays_behind_the_last_piece_until_the_writer_ends_the_file(tmp_path: Path) -> None:
    path = tmp_path / "log"
    file = GrowingFile(path, b"END")
    seen = []
    for piece in (b"first,", b"second,"):
        file.write(piece)
        file.flush()
        file.flush()
        seen.append(path.read_bytes())
    assert seen == [b"first,END", b"first,second,END"]
    file.finish()
    file.write(b"index.")
    file.close()
    assert path.read_bytes() == b"first,second,index."


def test_what_does_not_fit_leaves_the_tail_where_it_was(tmp_path: Path) -> None:
    path = tmp_path / "log"
    file = GrowingFile(path, b"END")
    file._file = Small(path)  # type: ignore[assignment]
    file.write(b"first,")
    file.flush()
    file.write(b"second,")
    file.finish()
    with pytest.raises(RecordError):
        file.close()
    assert path.read_bytes() == b"first,END"


def test_it_goes_nowhere_but_to_its_end(tmp_path: Path) -> None:
    file = GrowingFile(tmp_path / "log")
    file.write(b"abc")
    assert file.seek(0, 1) == file.seek(3) == 3
    with pytest.raises(ValueError, match="cannot seek"):
        file.seek(0)
    file.close()


def test_a_missing_folder_is_told(tmp_path: Path) -> None:
    with pytest.raises(RecordError, match="No such file"):
        GrowingFile(tmp_path / "nowhere" / "log")
