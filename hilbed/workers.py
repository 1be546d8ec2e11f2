"""What a process of a pool does first."""

from __future__ import annotations

import signal

from hilbed import compiled


def prepare() -> None:
    """Leaves Ctrl-C to the process that leads the pool, and uses what is compiled.

    Ctrl-C comes to every process of a terminal.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    compiled.prefer()
