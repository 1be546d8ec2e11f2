"""How the error flags of all nodes together end a frame, bit by bit.

ISO 11898-1. A node that sees an error sends a flag of six bits of one level, which breaks the rule of
stuffing, so that every other node sees an error and sends its own. The flags overlap to 6 to 12 bits; eight
recessive bits end the error frame.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

FLAG_BITS, DELIMITER_BITS = 6, 8
DOMINANT, RECESSIVE = 0, 1


class Sending(NamedTuple):
    """A node that sends: its frame bit by bit; active: its error flags are dominant; found: it has seen
    the error, others go on until they see that they are overruled."""

    bits: Sequence[int]
    active: bool
    found: bool


class Flags(NamedTuple):
    """Error flags of all nodes: bits on the bus; whether a receiver's flag ended before another node's."""

    bits: int
    first: bool


class _Sender:
    """left: bits of its error flag still to be sent, None before it has seen the error."""

    def __init__(self, sending: Sending) -> None:
        self.left = FLAG_BITS if sending.found else None
        self._bits = sending.bits
        self._flag = DOMINANT if sending.active else RECESSIVE

    def level(self, place: int) -> int:
        return self._bits[place] if self.left is None else self._flag if self.left else RECESSIVE

    def hear(self, place: int, level: int) -> None:
        if self.left:
            self.left -= 1
        elif self.left is None and self._bits[place] != level:
            self.left = FLAG_BITS


class _Receivers:
    """All error-active ones, which see the same; first: see Flags."""

    def __init__(self, seen: Sequence[int]) -> None:
        self.first = False
        self._last = seen[-1]
        self._run = next((k for k, level in enumerate(reversed(seen)) if level != self._last), len(seen))
        self.left = FLAG_BITS if self._run > 5 else None

    def level(self, _: int) -> int:
        return DOMINANT if self.left else RECESSIVE

    def hear(self, _: int, level: int) -> None:
        self._run = self._run + 1 if level == self._last else 1
        self._last = level
        if self.left:
            self.left -= 1
        elif self.left is None:
            self.left = FLAG_BITS if self._run > 5 else None
        else:
            self.first = self.first or level == DOMINANT


def flags(seen: Sequence[int], sending: Sequence[Sending], receivers: bool) -> Flags:
    """Plays what follows an error.

    seen: levels on the bus up to the bit with the error; receivers: whether error-active ones listen.
    """
    hearing = _Receivers(seen) if receivers else None
    nodes: list[_Sender | _Receivers] = [*map(_Sender, sending), *([hearing] if hearing else [])]
    place = len(seen)
    while True:
        level = min(node.level(place) for node in nodes)
        if level == RECESSIVE and all(node.left == 0 for node in nodes):
            return Flags(place - len(seen), hearing is not None and hearing.first)
        for node in nodes:
            node.hear(place, level)
        place += 1
