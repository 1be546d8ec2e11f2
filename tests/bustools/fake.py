"""An adapter whose other end is a test."""

from __future__ import annotations

from collections.abc import Iterable

from hilbed.bustools.live import LiveBus
from hilbed.can.hardware import Adapter
from hilbed.types import Frame


class FakeAdapter(Adapter):
    """Hands out what it was given, one frame at a time."""

    def __init__(self, frames: Iterable[Frame] = ()) -> None:
        self.name = "fake"
        self.coming = list(frames)
        self.sent: list[Frame] = []

    def send(self, frame: Frame) -> None:
        self.sent.append(frame)

    def poll(self) -> list[Frame]:
        return [self.coming.pop(0)] if self.coming else []

    def wait(self, timeout: float) -> list[Frame]:  # noqa: ARG002
        return self.poll()


def live(frames: Iterable[Frame] = ()) -> LiveBus:
    """Returns a live bus on which these frames come."""
    return LiveBus(FakeAdapter(frames))
