"""Starts a process that shares memory with this one, and ends it with all that it has started."""

from __future__ import annotations

import os
import signal
import socket
from contextlib import suppress
from mmap import mmap
from subprocess import Popen

from hilbed import offspring


def start(module: str, size: int) -> tuple[Popen[bytes], socket.socket, int, mmap]:
    """Returns a new child, this end of the line to it, what it prints, and memory (bytes) that both see.

    Its own hashes of strings are always the same.
    """
    memory = os.memfd_create("hilbed-shot")
    ours, theirs = socket.socketpair()
    printed, printing = os.pipe()
    os.set_blocking(printed, False)
    try:
        os.truncate(memory, size)
        shared = mmap(memory, 0)
        child = offspring.start(
            module,
            (theirs.fileno(), memory, os.getpid()),
            keep=(theirs.fileno(), memory),
            stdout=printing,
            stderr=printing,
            environment={"PYTHONHASHSEED": "0", "PYTHONUNBUFFERED": "1"},
        )
        return child, ours, printed, shared
    except OSError:
        ours.close()
        os.close(printed)
        raise
    finally:
        theirs.close()
        os.close(memory)
        os.close(printing)


def end(child: Popen[bytes], line: socket.socket, printed: int) -> None:
    """Ends a child and what it has started."""
    with suppress(ProcessLookupError, PermissionError):
        os.killpg(child.pid, signal.SIGKILL)
    child.kill()
    child.wait()
    line.close()
    os.close(printed)
