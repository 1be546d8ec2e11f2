"""A live camera: a device by its index, or a stream by its URL, read without ever waiting for long."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from hilbed.types import HilbedError, Image, Nanos, ScenarioError
from hilbed.vision.calibration import Optics
from hilbed.vision.child import Child, ChildLost
from hilbed.vision.lens import LARGEST, Lens
from hilbed.vision.seams import Shot

TIMEOUT = 5.0
"""s that a camera may take for each frame."""

OPENING = 10.0
"""s that it may take to open, where it may not take as long for a frame."""

_STARTUP = 60.0  # s that the process itself may take
_CHILD = "hilbed.vision.live_child"


class CameraLost(HilbedError):
    """A live camera has stopped to deliver."""


class _Taken(NamedTuple):
    image: Image
    t: Nanos


class LiveCamera:
    """The newest frame of a camera, each time one is asked for; those that nobody had time for are left out.

    Frames are stamped when they arrive, from the opening on. A child process reads the camera, so that one
    that blocks can be let go. Raises ScenarioError where the camera does not open within `timeout` s, at
    least `OPENING`, CameraLost where no frame follows within `timeout`.
    """

    def __init__(self, place: int | str, optics: Optics, timeout: float = TIMEOUT) -> None:
        self.name = f"camera {place}" if isinstance(place, int) else place
        self._timeout = timeout
        opening = max(timeout, OPENING)
        self._child = Child(_CHILD, LARGEST * LARGEST * 3, (place, opening, timeout))
        try:
            self._answer(_STARTUP)
            self._first = self._next(opening)
            if self._first is None:
                raise ScenarioError(f"{self.name}: cannot be opened")
            height, width, _ = self._first.image.shape
            self.lens: Lens = optics.lens(width, height, self.name)
        except CameraLost as error:
            self.close()
            raise ScenarioError(str(error)) from None
        except ScenarioError:
            self.close()
            raise

    def frames(self) -> Iterator[Shot]:
        """Yields frames until the stream ends; raises CameraLost where it only stops."""
        taken, self._first = self._first, None
        while taken is not None:
            if taken.image.shape[:2] != (self.lens.height, self.lens.width):
                raise CameraLost(f"{self.name}: has changed the size of its images")
            yield Shot(taken.image, taken.t, self.lens)
            taken = self._next(self._timeout)

    def close(self) -> None:
        """Lets the camera go."""
        self._child.close()

    def _next(self, patience: float) -> _Taken | None:
        """Returns the newest frame that nobody has had, None at the end."""
        try:
            self._child.send(b"\n")
        except ChildLost as error:
            raise CameraLost(f"{self.name}: {error}") from None
        answer = self._answer(patience)
        if answer.get("end"):
            raise CameraLost(f"{self.name}: {answer['end']}")
        if "end" in answer:
            return None
        image = self._child.image(tuple(answer["shape"])).copy()
        return _Taken(image, int(answer["t"]))

    def _answer(self, patience: float) -> dict[str, Any]:
        try:
            return self._child.answer(patience)
        except TimeoutError:
            raise CameraLost(f"{self.name}: no frame for {patience:g} s") from None
        except ChildLost as error:
            raise CameraLost(f"{self.name}: {error}") from None
