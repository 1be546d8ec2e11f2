"""Keeps a process that works for the bench off the processor that the bench itself runs on."""

from __future__ import annotations

import os
from contextlib import suppress

_STAT = 1024  # bytes of /proc/PID/stat, enough for all of it
_PROCESSOR = 36  # of the words after the name in /proc/PID/stat: where it ran last


class Aside:
    """Steps aside for another process, where there is another processor to go to.

    Some schedulers wake a process where the one that wakes it runs, even if another processor is idle; then
    the physics would stop for as long as its helper works. bench: number of the process to make room for.
    """

    def __init__(self, bench: int) -> None:
        self._processors = os.sched_getaffinity(0) if hasattr(os, "sched_getaffinity") else set()
        self._bench = -1
        with suppress(OSError):  # where the system does not tell, things stay as they are
            self._bench = os.open(f"/proc/{bench}/stat", os.O_RDONLY | os.O_CLOEXEC)

    def step(self) -> None:
        """Takes any processor but the one where the bench is now."""
        with suppress(OSError):  # the bench has gone, or /proc is not there
            status = os.pread(self._bench, _STAT, 0).rpartition(b")")[2].split()
            others = self._processors - {int(status[_PROCESSOR])}
            if others and others != os.sched_getaffinity(0):
                os.sched_setaffinity(0, others)
