"""A live camera: a device by its index, or a stream by its URL, read without ever waiting for long."""

from __future__ import annotations

from collections.abc import Iterator
from threading import Condition, Thread
from time import monotonic, monotonic_ns
from typing import NamedTuple

import cv2

from hilbed.types import HilbedError, Image, Nanos, ScenarioError
from hilbed.vision.calibration import Optics
from hilbed.vision.image_file import rgb
from hilbed.vision.lens import Lens
from hilbed.vision.seams import Shot
from hilbed.vision.video import be_quiet

TIMEOUT = 5.0
"""s that a camera may take to open, and for each frame."""


class CameraLost(HilbedError):
    """A live camera has stopped to deliver."""


class _Taken(NamedTuple):
    image: Image
    t: Nanos


class LiveCamera:
    """The newest frame of a camera, each time one is asked for; those that nobody had time for are left out.

    Frames are stamped when they arrive, from the opening on. A thread waits for the camera, so that nobody
    else has to: cv2.VideoCapture blocks. Raises ScenarioError where the camera does not open within `timeout`
    s, CameraLost where no frame follows within it.
    """

    def __init__(self, place: int | str, optics: Optics, timeout: float = TIMEOUT) -> None:
        self.name = f"camera {place}" if isinstance(place, int) else place
        self._place, self._timeout, self._start = place, timeout, monotonic_ns()
        self._news = Condition()
        self._newest: _Taken | None = None
        self._ended = self._closed = False
        Thread(target=self._watch, name=f"hilbed {self.name}", daemon=True).start()
        first = self._wait()
        if first is None:
            self.close()
            told = "cannot be opened" if self._ended else f"gives no frame within {timeout:g} s"
            raise ScenarioError(f"{self.name}: {told}")
        height, width, _ = first.image.shape
        try:
            self.lens: Lens = optics.lens(width, height, self.name)
        except ScenarioError:
            self.close()
            raise
        self._newest = first

    def frames(self) -> Iterator[Shot]:
        """Yields frames until the stream ends; raises CameraLost where it only stops."""
        while True:
            taken = self._wait()
            if taken is None and not self._ended:
                raise CameraLost(f"{self.name}: no frame for {self._timeout:g} s")
            if taken is None:
                return
            if taken.image.shape[:2] != (self.lens.height, self.lens.width):
                raise CameraLost(f"{self.name}: has changed the size of its images")
            yield Shot(taken.image, taken.t, self.lens)

    def close(self) -> None:
        """Lets the camera go, as soon as it lets go."""
        self._closed = True

    def _wait(self) -> _Taken | None:
        """Returns the newest frame that nobody has had, None at the end or after the timeout."""
        until = monotonic() + self._timeout
        with self._news:
            while self._newest is None and not self._ended:
                if not self._news.wait(until - monotonic()):
                    return None
            taken, self._newest = self._newest, None
        return taken

    def _watch(self) -> None:
        """Takes frames as they come; runs in a thread of its own until the camera ends or is closed."""
        try:
            capture = _open(self._place, self._timeout)
            while not self._closed:
                there, image = capture.read()
                if not there:
                    break
                taken = _Taken(rgb(image, self.name), monotonic_ns() - self._start)
                with self._news:
                    self._newest = taken
                    self._news.notify()
            capture.release()
        finally:
            with self._news:
                self._ended = True
                self._news.notify()


def _open(place: int | str, timeout: float) -> cv2.VideoCapture:
    """Opens a device or a stream; where it fails, reading gives nothing."""
    be_quiet()
    if isinstance(place, int):
        return cv2.VideoCapture(place)
    patience = round(1e3 * timeout)
    limits = [cv2.CAP_PROP_OPEN_TIMEOUT_MSEC, patience, cv2.CAP_PROP_READ_TIMEOUT_MSEC, patience]
    return cv2.VideoCapture(place, cv2.CAP_FFMPEG, limits)
