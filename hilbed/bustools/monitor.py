"""What is said on a bus, live: a line a message in a terminal, a line a frame elsewhere. Only listens."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from dataclasses import dataclass
from typing import TextIO

from hilbed.bustools.decoder import Decoder
from hilbed.bustools.live import LiveBus
from hilbed.clock import MILLISECOND, SECOND, seconds
from hilbed.types import Frame, Nanos, Received

REFRESH: Nanos = 100 * MILLISECOND
_HOME, _CLEAR_LINE, _CLEAR_REST = "\033[H", "\033[K", "\033[J"
_SMOOTHING = 0.1


@dataclass
class Seen:
    """A message's last frame, how many there were, and the mean time between them (ns)."""

    frame: Frame
    t: Nanos
    count: int = 1
    period: float = 0.0

    def again(self, received: Received) -> None:
        """Takes the next one."""
        gap = received.t - self.t
        self.period += (gap - self.period) * (_SMOOTHING if self.count > 1 else 1.0)
        self.frame, self.t = received.frame, received.t
        self.count += 1


class Screen:
    """A table of the messages heard, redrawn ten times a second; what has no room is left out."""

    def __init__(self, decoder: Decoder, out: TextIO, size: Callable[[], tuple[int, int]]) -> None:
        self._decoder = decoder
        self._out = out
        self._size = size
        self._seen: dict[tuple[int, bool], Seen] = {}
        self._due: Nanos = 0
        out.write("\033[2J")

    def take(self, received: Received) -> None:
        """Notes a frame."""
        key = received.frame.id, received.frame.extended
        seen = self._seen.get(key)
        if seen is None:
            self._seen[key] = Seen(received.frame, received.t)
        else:
            seen.again(received)

    def tick(self, t: Nanos) -> None:
        """Draws, if it is time."""
        if t >= self._due:
            self._due = t + REFRESH
            self.draw(t)

    def draw(self, t: Nanos) -> None:
        """Draws the table as it is now."""
        columns, rows = self._size()
        lines = [self._line(seen)[:columns] for _, seen in sorted(self._seen.items())]
        head = f"{seconds(t):.1f} s, {sum(seen.count for seen in self._seen.values())} frames, Ctrl-C ends"
        shown = [head[:columns], *lines][: rows - 1]
        self._out.write(_HOME + "".join(f"{line}{_CLEAR_LINE}\n" for line in shown) + _CLEAR_REST)
        self._out.flush()

    def _line(self, seen: Seen) -> str:
        name, content = self._decoder.decode(seen.frame)
        rate = f"{SECOND / seen.period:7.1f}/s" if seen.period else "         "
        return f"{name:24.24} {rate} {content}"


class Lines:
    """A line a frame: time, message, content."""

    def __init__(self, decoder: Decoder, out: TextIO) -> None:
        self._decoder = decoder
        self._out = out

    def take(self, received: Received) -> None:
        """Writes a frame's line."""
        name, content = self._decoder.decode(received.frame)
        self._out.write(f"{seconds(received.t):.6f} {name} {content}".rstrip() + "\n")

    def tick(self, t: Nanos) -> None:  # noqa: ARG002
        """Lets a reader at the other end of a pipe have what there is."""
        self._out.flush()


def monitor(
    bus: LiveBus, display: Screen | Lines, stop: Callable[[], bool], duration: Nanos | None = None
) -> None:
    """Shows what is heard until `stop` says so or `duration` is over; BusError where the bus is lost."""
    t = bus.now
    while not stop() and (duration is None or t < duration):
        t = bus.pump(t)
        for received in bus.recv(t):
            display.take(received)
        display.tick(t)


def terminal_size() -> tuple[int, int]:
    """Returns columns and rows of the terminal."""
    size = shutil.get_terminal_size()
    return size.columns, size.lines
