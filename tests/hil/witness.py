"""candump of can-utils as a witness of what was on the bus."""

from __future__ import annotations

import subprocess
import time
from pathlib import Path
from types import TracebackType
from typing import NamedTuple

import can

from tests.hil.processes import VCAN

_FIRST, _LAST = "1FFFFFFE#", "1FFFFFFF#"
_PATIENCE = 20.0


class Seen(NamedTuple):
    """One line of candump -L: s since 1970 and the frame as ID#DATA."""

    at: float
    frame: str


class Candump:
    """Writes down everything on the bus, between two frames of its own that show that it listens."""

    def __init__(self, file: Path) -> None:
        self._file = file

    def __enter__(self) -> Candump:
        with self._file.open("w") as out:
            # Root's receive buffer, so that no frame is lost while others have the processor.
            self._process = subprocess.Popen(["candump", "-L", "-r", "8000000", VCAN], stdout=out)
        self._mark(_FIRST)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._process.kill()
        self._process.wait()

    def seen(self) -> list[Seen]:
        """Returns all that was on the bus until now."""
        self._mark(_LAST)
        return [seen for seen in self._read() if seen.frame not in (_FIRST, _LAST)]

    def _mark(self, frame: str) -> None:
        """Sends a frame until candump has it: what was sent before, it has as well."""
        deadline = time.monotonic() + _PATIENCE
        before = self._count(frame)
        with can.Bus(VCAN, interface="socketcan") as bus:
            while self._count(frame) == before:
                assert time.monotonic() < deadline, f"candump does not see {frame}"
                bus.send(can.Message(arbitration_id=int(frame[:-1], 16)))
                time.sleep(0.01)

    def _count(self, frame: str) -> int:
        return sum(seen.frame == frame for seen in self._read())

    def _read(self) -> list[Seen]:
        complete = self._file.read_text().splitlines(keepends=True)
        lines = (line.split() for line in complete if line.endswith("\n"))
        return [Seen(float(stamp[1:-1]), frame) for stamp, _, frame in lines]
