"""What runs behind a live camera: `python -m hilbed.vision.live_child SOCKET MEMORY PARENT`.

A thread waits for the camera, since cv2.VideoCapture blocks, and keeps the newest frame; each request gets
one that has not been given yet. The process can be ended at any time, a thread in OpenCV cannot.
"""

from __future__ import annotations

import json
import os
import pickle
import socket
import sys
from collections.abc import Iterator
from contextlib import suppress
from io import BufferedRWPair
from mmap import mmap
from threading import Condition, Thread
from time import monotonic_ns
from typing import Any, NamedTuple

import cv2
import numpy as np

from hilbed.clock import SECOND
from hilbed.types import HilbedError, Image, Nanos
from hilbed.vision.image_file import rgb
from hilbed.vision.lifeline import end_with
from hilbed.vision.video import be_quiet

_MOST = 0.9  # of the timeout: an end is told at once


class Taken(NamedTuple):
    """A frame and when it came, ns since the opening."""

    image: Image
    t: Nanos


class Watch:
    """Takes frames as they come, in a thread of its own, until the camera ends; why: empty at a mere end."""

    def __init__(self, place: int | str, opening: float, timeout: float) -> None:
        self._given, self._start = (place, opening, timeout), monotonic_ns()
        self._news = Condition()
        self._newest: Taken | None = None
        self._ended, self.why = False, ""
        Thread(target=self._run, daemon=True).start()

    def newest(self) -> Taken | None:
        """Waits for the newest frame that has not been given yet; None at the end."""
        with self._news:
            self._news.wait_for(lambda: self._newest is not None or self._ended)
            taken, self._newest = self._newest, None
        return taken

    def _run(self) -> None:
        try:
            for image in _images(*self._given):
                self._tell(Taken(rgb(image, "a frame"), monotonic_ns() - self._start), False)
        except (HilbedError, cv2.error) as error:
            self.why = str(error)
        self._tell(None, True)

    def _tell(self, taken: Taken | None, ended: bool) -> None:
        with self._news:
            self._newest, self._ended = taken or self._newest, ended
            self._news.notify()


def _images(place: int | str, opening: float, timeout: float) -> Iterator[Any]:
    """Yields what a device or a stream gives; nothing where it does not open.

    opening, timeout: s, to open and for a frame. Raises HilbedError where it stalls: OpenCV gives up after
    the timeout as if that were the end.
    """
    be_quiet()
    limits = [cv2.CAP_PROP_OPEN_TIMEOUT_MSEC, round(1e3 * opening)]
    limits += [cv2.CAP_PROP_READ_TIMEOUT_MSEC, round(1e3 * timeout)]
    capture = (
        cv2.VideoCapture(place) if isinstance(place, int) else cv2.VideoCapture(place, cv2.CAP_FFMPEG, limits)
    )
    while True:
        asked = monotonic_ns()
        there, image = capture.read()
        if not there and monotonic_ns() - asked > _MOST * timeout * SECOND:
            raise HilbedError(f"no frame for {timeout:g} s")
        if not there:
            return
        yield image


def answer(watch: Watch, memory: mmap) -> dict[str, Any]:
    """Puts the newest frame into the memory and returns its time and shape, or that it is over."""
    taken = watch.newest()
    if taken is None:
        return {"end": watch.why}
    image, t = taken
    if image.size > len(memory):
        return {"end": f"its frames of {image.shape[1]}×{image.shape[0]} pixels are too large"}
    np.frombuffer(memory, np.uint8, image.size)[:] = image.ravel()
    return {"t": t, "shape": image.shape}


def _say(line: BufferedRWPair, message: dict[str, Any]) -> None:
    line.write(json.dumps(message).encode() + b"\n")
    line.flush()


def main() -> None:
    descriptor, shared, parent = map(int, sys.argv[1:])
    end_with(parent)
    line, memory = socket.socket(fileno=descriptor).makefile("rwb"), mmap(shared, 0)
    with suppress(OSError, EOFError):  # whoever looks has gone
        _say(line, {"ready": True})
        watch = Watch(*pickle.load(line))
        for _ in line:
            _say(line, answer(watch, memory))
    os._exit(0)  # the thread is not waited for


if __name__ == "__main__":
    main()
