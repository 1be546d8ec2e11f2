"""What a foreign detector did wrong over a run, counted and in words, and what it printed."""

from __future__ import annotations

from collections import deque
from typing import get_args

from hilbed.clock import seconds
from hilbed.types import Nanos
from hilbed.vision.detectors import AnyDetector, ForeignSpec
from hilbed.vision.seams import Failure, Trouble, quoted

KEPT = 1 << 20
"""characters of what a detector prints that a run keeps: the last."""


class Troubles:
    """The frames of a camera and those without an answer; foreign: whether there can be any such."""

    def __init__(self, detector: AnyDetector) -> None:
        self.foreign = isinstance(detector, ForeignSpec)
        self._frames = 0
        self._counts: dict[str, int] = dict.fromkeys(get_args(Failure), 0)
        self._first: dict[str, tuple[Nanos, Trouble]] = {}
        self._heard: deque[str] = deque()
        self._length = 0

    def note(self, t: Nanos, trouble: Trouble | None) -> None:
        """Counts a frame of exposure t."""
        self._frames += 1
        if trouble is not None:
            self._counts[trouble.failure] += 1
            self._first.setdefault(trouble.failure, (t, trouble))

    def hear(self, t: Nanos, said: str) -> None:
        """Keeps what was printed for the frame of exposure t; what came long before makes room for it."""
        if said:
            self._heard.append(f"t = {seconds(t):.3f} s\n{said.rstrip()}\n")
            self._length += len(self._heard[-1])
        while self._length > KEPT:
            self._length -= len(self._heard.popleft())

    def counts(self) -> dict[str, float]:
        """Returns frames asked for, and those without an answer by their failure."""
        return {"frames": self._frames, **self._counts}

    @property
    def reproducible(self) -> bool:
        """Tells whether no frame was lost to the wall clock."""
        return not self._counts["late"]

    @property
    def heard(self) -> str:
        """What was printed, below the time of its frame; empty where nothing was."""
        return "".join(self._heard)

    def lines(self) -> list[str]:
        """Returns each kind of failure: how often, when first, where and what, the last lines it printed."""
        return [
            f"{failure} {self._counts[failure]} of {self._frames} frames, "
            f"first at t = {seconds(t):.3f} s: {trouble.text}{quoted(trouble.said)}"
            for failure, (t, trouble) in self._first.items()
        ]
