"""One attempt to send where something may go wrong: two senders, a disturbed bit, nobody who answers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from hilbed.can.error_frame import DELIMITER_BITS, DOMINANT, RECESSIVE, Sending, flags
from hilbed.can.frame_layout import ACKNOWLEDGE
from hilbed.types import ACK_ERROR, BIT_ERROR, NO_ERROR


class Contender(NamedTuple):
    """A frame that has won arbitration, bit by bit; active: its node's error flags are dominant."""

    bits: Sequence[int]
    active: bool


class Listeners(NamedTuple):
    """The other nodes: whether there are any, and any whose error flags are dominant."""

    any: bool
    active: bool


class Attempt(NamedTuple):
    """How it ended: bits on the bus (error flags and delimiter included), what was wrong (NO_ERROR, …).

    senders: indices of the contenders that were sending to the end, several where their frames are alike or
    failed together; the others were overruled and, being error passive, did not disturb. first: a
    receiver's error flag was over before another's.
    """

    bits: int
    error: int
    senders: tuple[int, ...]
    first: bool = False


def attempt(contenders: Sequence[Contender], listeners: Listeners, disturbed: int | None = None) -> Attempt:
    """Returns how it goes; disturbed: index of the bit that comes out inverted on the bus, if any."""
    sending = dict(enumerate(contenders))
    while True:
        parting = _parting([*sending.values()])
        if disturbed is not None and (parting is None or disturbed <= parting):
            level = 1 - min(one.bits[disturbed] for one in sending.values())
            return _cut(BIT_ERROR, sending, disturbed, level, listeners)
        if parting is None:
            break
        overruled = {k for k, one in sending.items() if one.bits[parting] == RECESSIVE}
        if any(sending[k].active for k in overruled):
            return _cut(BIT_ERROR, sending, parting, DOMINANT, listeners)
        sending = {k: one for k, one in sending.items() if k not in overruled}
    bits = len(next(iter(sending.values())).bits)
    if not listeners.any:
        return _cut(ACK_ERROR, sending, bits + ACKNOWLEDGE, RECESSIVE, listeners)
    return Attempt(bits, NO_ERROR, tuple(sending))


def _parting(sending: Sequence[Contender]) -> int | None:
    """Returns the index of the first bit in which the frames differ, None if they are alike."""
    for place, levels in enumerate(zip(*(one.bits for one in sending), strict=False)):
        if min(levels) != max(levels):
            return place
    return None


def _cut(
    error: int, sending: Mapping[int, Contender], place: int, level: int, listeners: Listeners
) -> Attempt:
    """Returns the attempt that fails at a bit with the level that the bus shows there."""
    contenders = [*sending.values()]
    nodes = [Sending(bits, active, error == ACK_ERROR or bits[place] != level) for bits, active in contenders]
    shown = flags([*contenders[0].bits[:place], level], nodes, listeners.active)
    return Attempt(place + 1 + shown.bits + DELIMITER_BITS, error, tuple(sending), shown.first)
