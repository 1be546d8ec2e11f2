"""The far end of an slcan adapter: a pseudo-terminal, whose other side python-can's driver opens."""

from __future__ import annotations

import os
import tty
from collections.abc import Iterator
from contextlib import contextmanager


class Line:
    """path: what to give as channel; `read` waits until lines with frames have come, `write` sends bytes."""

    def __init__(self) -> None:
        self._end, self._other = os.openpty()
        tty.setraw(self._end)
        self.path = os.ttyname(self._other)
        self._rest = b""
        self._open = True

    def read(self, count: int) -> list[str]:
        """Returns the next `count` lines that hold a frame."""
        frames: list[str] = []
        while len(frames) < count:
            line, found, rest = self._rest.partition(b"\r")
            if not found:
                self._rest += os.read(self._end, 4096)
                continue
            self._rest = rest
            if line[:1] in (b"t", b"T", b"r", b"R"):
                frames.append(line.decode())
        return frames

    def write(self, data: bytes) -> None:
        os.write(self._end, data)

    def unplug(self) -> None:
        """Closes the pseudo-terminal under the driver."""
        if self._open:
            os.close(self._end)
            os.close(self._other)
            self._open = False


@contextmanager
def line() -> Iterator[Line]:
    one = Line()
    try:
        yield one
    finally:
        one.unplug()
