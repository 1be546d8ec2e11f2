"""The terminal: progress when somebody watches, results when somebody pipes."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from io import TextIOWrapper
from types import FrameType


class Stop:
    """A request to end, set by SIGINT or SIGTERM; a second SIGINT interrupts at once."""

    def __init__(self) -> None:
        self.signal: str | None = None

    def __call__(self, number: int, _: FrameType | None) -> None:
        if self.signal is not None:
            raise KeyboardInterrupt
        self.signal = signal.Signals(number).name


@contextmanager
def stop_on_signal() -> Iterator[Stop]:
    """Turns SIGINT and SIGTERM into a request that a loop can honour between two cycles."""
    stop = Stop()
    previous = {number: signal.signal(number, stop) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield stop
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler)


def open_streams() -> None:
    """Puts the null device where standard input, output or error is closed.

    Else the next file to be opened, a log perhaps, would take the stream's place.
    """
    for name in ("stdin", "stdout", "stderr"):
        if getattr(sys, name) is None:
            nowhere = os.open(os.devnull, os.O_RDWR)  # takes the lowest number that is free: this stream's
            setattr(sys, name, os.fdopen(nowhere, "r" if name == "stdin" else "w"))


@contextmanager
def quiet_pipe() -> Iterator[None]:
    """Ends quietly when whoever reads the results has gone away; a narrow encoding shows "?" for "≤"."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="replace")
    try:
        yield
        sys.stdout.flush()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def progress(text: str) -> None:
    """Shows a line on stderr over the previous one, only where it is a terminal."""
    if sys.stderr.isatty():
        sys.stderr.write(f"\r\033[K{text}")
        sys.stderr.flush()


def end_progress() -> None:
    """Takes the progress line away."""
    progress("")
