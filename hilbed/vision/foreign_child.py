"""What runs behind a foreign detector: `python -m hilbed.vision.foreign_child SOCKET MEMORY PARENT`."""

from __future__ import annotations

import faulthandler
import json
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

from hilbed.types import Image
from hilbed.vision.foreign_code import Refused, blame, make
from hilbed.vision.lifeline import end_with
from hilbed.vision.returned import plain
from hilbed.vision.seams import Shot


def answers(line: BufferedRWPair, shared: Image) -> Iterator[dict[str, Any]]:
    """Yields whether the detector is made, then an answer to each frame, until the bench has gone."""
    code, options, lens = pickle.load(line)
    try:
        detector = make(code, options)
    except Refused as error:
        yield {"refused": str(error)}
        return
    yield {"ready": str(code)}
    image = shared[: lens.height * lens.width * 3].reshape(lens.height, lens.width, 3)
    for request in line:
        yield answer(detector, Shot(image.copy(), json.loads(request)["t"], lens))


def answer(detector: Any, shot: Shot) -> dict[str, Any]:
    """Returns what the detector makes of a frame, or what it did instead."""
    try:
        returned = detector.detect(shot)
    except BaseException as error:  # sys.exit() is no way out, either
        return {"raised": blame(error)}
    try:
        return {"rows": plain(returned)}
    except ValueError as error:
        return {"invalid": str(error)}
    except BaseException as error:  # raised by what it returned
        return {"invalid": blame(error)}


def main() -> None:
    descriptor, memory, parent = map(int, sys.argv[1:])
    end_with(parent)  # even while foreign code never comes back
    faulthandler.enable()
    faulthandler.register(signal.SIGUSR1)
    line = socket.socket(fileno=descriptor).makefile("rwb")
    shared = np.frombuffer(mmap(memory, 0), np.uint8)
    with suppress(OSError, EOFError):  # the bench has gone
        for each in answers(line, shared):
            line.write(json.dumps(each).encode() + b"\n")
            line.flush()
    os._exit(0)  # foreign threads are not waited for


if __name__ == "__main__":
    main()
