"""A hub of serial CAN adapters (slcan) on pseudo-terminals: what one sends, all others receive."""

from __future__ import annotations

import os
import select
import threading
import tty
from typing import Self

QUICK = {"CAN_CONFIG": '{"sleep_after_open": 0}'}
"""Environment of processes on a hub: python-can lets a serial adapter start for two seconds otherwise."""
_END = 255


class Hub:
    """Pseudo-terminals; python-can opens each of `paths` as if it were a serial adapter on one bus."""

    def __init__(self, ports: int) -> None:
        pairs = [os.openpty() for _ in range(ports)]
        self._masters = [master for master, _ in pairs]
        self._slaves = [slave for _, slave in pairs]
        for slave in self._slaves:  # kept open: no hang-up between two programs
            tty.setraw(slave)
        self.paths = [os.ttyname(slave) for slave in self._slaves]
        self._lines = dict.fromkeys(self._masters, b"")
        self._orders, self._order = os.pipe()
        self._thread = threading.Thread(target=self._run, daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def unplug(self, port: int) -> None:
        """Takes an adapter away from whoever has it open."""
        os.write(self._order, bytes((port,)))

    def __exit__(self, *_: object) -> None:
        os.write(self._order, bytes((_END,)))
        self._thread.join()
        for number in (*self._masters, *self._slaves, self._orders, self._order):
            os.close(number)

    def _run(self) -> None:
        while True:
            ready, _, _ = select.select([self._orders, *self._masters], [], [])
            for master in self._masters:
                if master in ready:
                    self._take(master)
            if self._orders in ready:
                (port,) = os.read(self._orders, 1)
                if port == _END:
                    return
                os.close(self._slaves.pop(port))
                os.close(self._masters.pop(port))

    def _take(self, master: int) -> None:
        *lines, self._lines[master] = (self._lines[master] + os.read(master, 65536)).split(b"\r")
        frames = b"".join(line + b"\r" for line in lines if line[:1] in (b"t", b"T", b"r", b"R"))
        for other in self._masters:
            if frames and other != master:
                os.write(other, frames)
