"""What a process of a pool does first."""

from __future__ import annotations

import signal

from hilbed import compiled


def prepare() -> None:
    """Leaves Ctrl-C, which comes to every process of a terminal, to the one that leads the pool."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    compiled.prefer()
