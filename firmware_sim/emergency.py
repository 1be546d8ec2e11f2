"""EMCY producer: sends what the errors have to say, no faster than the inhibit time (1014, 1015)."""

from __future__ import annotations

from typing import Any

from firmware_sim.entry import key
from firmware_sim.errors import Errors
from firmware_sim.frame import Frame
from firmware_sim.objects.pdo import OFF
from firmware_sim.watchdog import NEVER

_COB, _INHIBIT = key(0x1014), key(0x1015)


class Emergency:
    __slots__ = ("_errors", "_quiet_until", "_values")

    def __init__(self, values: dict[int, Any], errors: Errors) -> None:
        self._values = values
        self._errors = errors
        self._quiet_until = -NEVER

    def flush(self, t: int, talking: bool) -> list[Frame]:
        """Returns the frames that may go out now; a node that may not talk forgets them."""
        pending, cob = self._errors.pending, self._values[_COB]
        if not talking or cob & OFF:
            pending.clear()
        frames = []
        while pending and t >= self._quiet_until:
            frames.append(Frame(cob & 0x7FF, pending.pop(0)))
            self._quiet_until = t + self._values[_INHIBIT] * 100_000
        return frames
