"""An own channel in real time: as long as another thread uses it, its time is that of the wall clock."""

from __future__ import annotations

import threading
import time

from can import BusABC, Notifier

from hilbed.can.channels import Channel
from hilbed.types import Nanos

_LEAST_WAIT, _LONGEST_WAIT = 50e-6, 0.5  # s


def shared(channel: Channel) -> bool:
    """Returns whether another thread uses an own channel: it has sent or received, or a Notifier will."""
    if threading.active_count() < 2:
        return False
    return channel.crowded or any(
        Notifier.find_instances(bus) for bus in tuple(channel.buses) if isinstance(bus, BusABC)
    )


def of(channel: Channel) -> Live | None:
    """Returns what keeps an own channel to the wall clock, None where the present thread alone uses it."""
    if threading.get_ident() not in channel.visitors:
        channel.visit()
    if not shared(channel):
        channel.live = None
        channel.visitors = {threading.get_ident(): threading.current_thread()}
    elif channel.live is None:
        channel.live = Live(channel)
    return channel.live


class Live:
    """Lets the simulated time of a channel follow the wall clock; whoever calls holds the channel's lock."""

    def __init__(self, channel: Channel) -> None:
        self._channel = channel
        self._ahead: Nanos = channel.wire.now - time.monotonic_ns()

    def catch_up(self) -> None:
        """Runs the wire to the present moment."""
        self._channel.wire.advance(max(self._channel.wire.now, time.monotonic_ns() + self._ahead))

    def wait(self, deadline: float | None) -> bool:
        """Waits until something may have come; False where the deadline (monotonic s) is over."""
        wire = self._channel.wire
        rest = (wire.due - wire.now) * 1e-9
        return wait(self._channel, deadline, min(max(rest, _LEAST_WAIT), _LONGEST_WAIT))


def wait(channel: Channel, deadline: float | None, most: float = _LONGEST_WAIT) -> bool:
    """Gives `changed` away until it is told, for `most` s at most; False where the deadline is over."""
    left = most if deadline is None else min(most, deadline - time.monotonic())
    if left <= 0:
        return False
    channel.waiting += 1
    try:
        channel.changed.wait(left)
    finally:
        channel.waiting -= 1
    return True
