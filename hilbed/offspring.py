"""Starts processes of the bench's own: they find modules where it does, and Ctrl-C does not hit them."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping, Sequence
from subprocess import DEVNULL, Popen
from typing import IO, TypeAlias

Stream: TypeAlias = int | IO[bytes]


def start(
    module: str,
    arguments: Sequence[object] = (),
    *,
    keep: Sequence[int] = (),
    stdin: Stream = DEVNULL,
    stdout: Stream = DEVNULL,
    stderr: Stream = DEVNULL,
    environment: Mapping[str, str] = {},
) -> Popen[bytes]:
    """Returns a process that runs a module as `python -m` does; OSError where there can be none.

    keep: descriptors that it has, too; environment: what is different in its own.
    """
    path = os.pathsep.join(entry or os.getcwd() for entry in sys.path)
    return Popen(
        [sys.executable, "-P", "-m", module, *map(str, arguments)],
        env={**os.environ, "PYTHONPATH": path, **environment},
        pass_fds=tuple(keep),
        process_group=0,
        stdin=stdin,
        stdout=stdout,
        stderr=stderr,
    )
