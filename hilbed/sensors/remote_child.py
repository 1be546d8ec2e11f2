"""What runs behind a remote eye: `python -m hilbed.sensors.remote_child SOCKET MEMORY`, descriptors both."""

from __future__ import annotations

import os
import pickle
import signal
import socket
import sys
from collections.abc import Iterator
from contextlib import suppress
from io import BufferedRWPair
from mmap import mmap
from typing import Any

import numpy as np

from hilbed import collector
from hilbed.cost import Cost
from hilbed.sensors.camera import open_eye
from hilbed.sensors.remote import EyeLost
from hilbed.types import HilbedError, Image
from hilbed.vision.lifeline import end_with

_STAT = 1024  # bytes of /proc/PID/stat, enough for all of it
_PROCESSOR = 36  # of the words after the name in /proc/PID/stat: where it ran last


def requests(line: BufferedRWPair) -> Iterator[Any]:
    """Yields what the bench asks for until it has gone."""
    with suppress(EOFError, OSError):
        while True:
            yield pickle.load(line)


def answers(asked: Iterator[Any], shared: Image) -> Iterator[object]:
    """Yields an answer to each request; an error is an answer, too, and the last one."""
    try:
        yield from frames(asked, shared)
    except HilbedError as error:
        yield error
    except Exception as error:
        yield EyeLost(f"the camera's own process has failed: {error!r}")


def frames(asked: Iterator[Any], shared: Image) -> Iterator[object]:
    """Yields None when the eye is ready; then, with each image in `shared`, findings and seconds it took.

    asked: first spec and setting, then the exposure of each frame.
    """
    spec, setting = next(asked)
    cost, processors = Cost(), os.sched_getaffinity(0)
    eye = open_eye(spec, setting, cost)
    bench = watch(os.getppid())
    yield None
    for exposure in asked:
        step_aside(processors, bench)
        render, vision = cost.render, cost.vision
        image, *told = eye.look(exposure)()
        np.copyto(shared.reshape(image.shape), image)
        yield *told, cost.render - render, cost.vision - vision


def watch(process: int) -> int:
    """Returns a descriptor of what the system tells of a process, −1 where it tells nothing."""
    try:
        return os.open(f"/proc/{process}/stat", os.O_RDONLY | os.O_CLOEXEC)
    except OSError:
        return -1


def step_aside(processors: set[int], bench: int) -> None:
    """Keeps this process off the one of its processors that the bench runs on, if there is another.

    Some schedulers wake a process where the one that wakes it runs, even if another processor is idle; then
    a frame would stop the physics for as long as it takes. bench: what `watch` gave.
    """
    with suppress(OSError):  # the bench has gone, or /proc is not there: then things stay as they are
        status = os.pread(bench, _STAT, 0).rpartition(b")")[2].split()
        others = processors - {int(status[_PROCESSOR])}
        if others and others != os.sched_getaffinity(0):
            os.sched_setaffinity(0, others)


def main() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the bench decides when it is over
    signal.signal(signal.SIGTERM, lambda *_: sys.exit())
    end_with(os.getppid(), signal.SIGTERM)  # even while it waits for a foreign detector
    descriptor, memory = map(int, sys.argv[1:])
    line = socket.socket(fileno=descriptor).makefile("rwb")
    shared = np.frombuffer(mmap(memory, 0), np.uint8)
    with suppress(OSError), collector.paused():  # the bench has gone
        for answer in answers(requests(line), shared):
            pickle.dump(answer, line)
            line.flush()


if __name__ == "__main__":
    main()
