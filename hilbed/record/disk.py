"""Logs on disk: they grow by whole pieces, and a full disk is an error with a name."""

from __future__ import annotations

from os import SEEK_CUR
from pathlib import Path

from hilbed.types import HilbedError


class RecordError(HilbedError):
    """What the run records cannot be written any more (disk full, folder gone); the run has to end."""


class GrowingFile:
    """A file that only ever grows by whole pieces, so that after a kill it ends with a complete one.

    tail: what a format wants at its end. It follows the last piece until the next one takes its place, so
    that the file is whole at any time; `finish` says that the writer's own end comes now.

    Writes are kept in memory until `flush`, which hands them to the operating system in one piece. A piece
    that does not fit on the disk is taken back entirely and remembered; `check` tells about it. `flush`
    itself never raises, since it may be called from inside a library that would swallow the exception.
    """

    def __init__(self, path: Path, tail: bytes = b"") -> None:
        self._path = path
        self._tail = tail
        self._finished = False
        self._pending: list[bytes] = []
        self._position = 0
        self._size = 0
        self._error: OSError | None = None
        try:
            self._file = path.open("wb", buffering=0)
        except OSError as error:
            raise RecordError(f"{path}: {error.strerror}") from error

    def write(self, data: bytes | bytearray) -> int:
        """Keeps a copy of the data for the next `flush` and returns its length."""
        self._pending.append(bytes(data))
        self._position += len(data)
        return len(data)

    def seek(self, offset: int, whence: int = 0) -> int:
        """Returns the position; going anywhere else is refused with ValueError."""
        if (self._position + offset if whence == SEEK_CUR else offset) != self._position:
            raise ValueError("a growing file cannot seek")
        return self._position

    def flush(self) -> None:
        """Appends all that is pending in one piece, or nothing at all."""
        piece = b"".join(self._pending)
        self._pending.clear()
        if not piece or self._error is not None or self._file.closed:
            return
        try:
            self._append(piece if self._finished else piece + self._tail)
            self._size += len(piece)
        except OSError as error:
            self._error = error
            self._take_back()

    def finish(self) -> None:
        """Leaves the end of the file to what is written from now on."""
        self._finished = True

    def _append(self, data: bytes) -> None:
        rest = memoryview(data)
        self._file.seek(self._size)
        while rest:
            rest = rest[self._file.write(rest) or 0 :]

    def _take_back(self) -> None:
        try:
            self._file.truncate(self._size)
            if self._size:
                self._append(self._tail)
        except OSError:
            return  # a device, or not even that much room

    def check(self) -> None:
        """Raises RecordError if a piece could not be written."""
        if self._error is not None:
            raise RecordError(f"{self._path}: {self._error.strerror}")

    def close(self) -> None:
        """Flushes and closes; raises RecordError if anything is missing in the file."""
        self.flush()
        self._file.close()
        self.check()
