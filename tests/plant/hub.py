"""A hub of serial CAN adapters (slcan) on pseudo-terminals: what one sends, all others receive."""

from __future__ import annotations

import os
import select
import threading
import tty
from typing import Self


class Hub:
    """Pseudo-terminals whose `paths` python-can's slcan driver opens as if each were an adapter on one bus."""

    def __init__(self, ports: int) -> None:
        pairs = [os.openpty() for _ in range(ports)]
        self._masters = [master for master, _ in pairs]
        self._slaves = [slave for _, slave in pairs]
        for slave in self._slaves:  # kept open: no hang-up between two programs
            tty.setraw(slave)
        self.paths = [os.ttyname(slave) for slave in self._slaves]
        self._lines = {master: b"" for master in self._masters}
        self._wake, self._alarm = os.pipe()
        self._thread = threading.Thread(target=self._run, daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        os.write(self._alarm, b"!")
        self._thread.join()
        for number in (*self._masters, *self._slaves, self._wake, self._alarm):
            os.close(number)

    def _run(self) -> None:
        while True:
            ready, _, _ = select.select([self._wake, *self._masters], [], [])
            if self._wake in ready:
                return
            for master in ready:
                self._take(master)

    def _take(self, master: int) -> None:
        *lines, self._lines[master] = (self._lines[master] + os.read(master, 65536)).split(b"\r")
        frames = b"".join(line + b"\r" for line in lines if line[:1] in (b"t", b"T", b"r", b"R"))
        for other in self._masters:
            if frames and other != master:
                os.write(other, frames)
