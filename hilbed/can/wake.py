"""Resets real drives and waits until they are up: in their own time, which may be seconds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeAlias

from hilbed.can import nmt
from hilbed.can.node import Node
from hilbed.types import BusError, Frame, Nanos, Received

PATIENCE = 5.0
"""s of the wall clock."""
REPEAT = 0.2
"""s of the wall clock; so often somebody is asked whether to go on."""

Waker: TypeAlias = Callable[[Nanos, Callable[[], None]], None]
"""Brings up, at a time (ns), what is elsewhere; asks its second argument whether to go on."""


class Wake:
    """Real drives on a bus before a run.

    send: sends a frame at once; pull: takes in what comes, by way of `take`, and waits for at most so many
    s; clock: s, steady.
    """

    def __init__(
        self,
        nodes: Sequence[Node],
        send: Callable[[Frame], None],
        pull: Callable[[Nanos, float], None],
        clock: Callable[[], float],
    ) -> None:
        self._nodes = tuple(nodes)
        self._send = send
        self._pull = pull
        self._clock = clock
        self._heard = nmt.HeartbeatConsumer()

    def take(self, frame: Frame) -> bool:
        """Looks at a frame, which goes on its way."""
        self._heard.hear(Received(0, frame))
        return False

    def up(self, t: Nanos, going: Callable[[], None]) -> None:
        """Resets all drives; BusError with those that have not said within `PATIENCE` that they are up.

        going: asked again and again; raises where that is to end.
        """
        for node in self._nodes:
            self._send(nmt.command(nmt.RESET_NODE, node.id))
        deadline = self._clock() + PATIENCE
        while missing := [node for node in self._nodes if node.id not in self._heard.boots]:
            going()
            left = deadline - self._clock()
            if left <= 0.0:
                names = ", ".join(map(str, missing))
                raise BusError(
                    f"{names}: no boot-up message within {PATIENCE:g} s of the NMT reset: is it powered and "
                    "wired, with this node number and bit rate?"
                )
            self._pull(t, min(left, REPEAT))
