"""Silence for libraries that write past Python, straight to the process's file descriptors."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def muted() -> Iterator[None]:
    """Sends standard output and error of the whole process nowhere, C libraries' included.

    PyBullet greets on import and warns about URDFs; `--json` promises nothing but the verdict.
    """
    flush = ctypes.CDLL(None).fflush
    flush(None)
    kept = [os.dup(descriptor) for descriptor in (1, 2)]
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        for descriptor in (1, 2):
            os.dup2(nowhere, descriptor)
        yield
    finally:
        flush(None)
        for descriptor, copy in zip((1, 2), kept, strict=True):
            os.dup2(copy, descriptor)
            os.close(copy)
        os.close(nowhere)
