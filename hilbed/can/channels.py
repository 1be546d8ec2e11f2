"""The channels of the python-can interface "hilbed": wires by name, shared by every bus of this process.

A bench lends its wire while it runs and then owns the time. A channel that nobody lent belongs to the
python-can buses that opened it: whoever receives moves its time on.
"""

from __future__ import annotations

import threading
import weakref
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from hilbed.can.port import Listener, Port
from hilbed.can.wire import Wire
from hilbed.types import BusError

if TYPE_CHECKING:
    from hilbed.can.live import Live


class Channel:
    """A wire, how many python-can buses are open on it, and what keeps their threads apart.

    bench: the thread of the bench that lends it and moves its time without a lock; None for an own channel.
    lock: held by whoever touches an own channel; changed: the same, told when something has arrived or was
    queued.
    waiting: threads that want to be told. visitors: threads that have used the channel; buses: the
    python-can ones on it. live: what keeps its time to the wall clock, if anything.
    """

    def __init__(self, wire: Wire, bench: threading.Thread | None = None) -> None:
        self.wire = wire
        self.bench = bench
        self.users = 0
        self.lock = threading.RLock()
        self.changed = threading.Condition(self.lock)
        self.waiting = 0
        self.visitors: dict[int, threading.Thread] = {}
        self.buses: weakref.WeakSet[object] = weakref.WeakSet()
        self.live: Live | None = None

    @property
    def elsewhere(self) -> bool:
        """Whether the wire is moved by a thread that is not the present one."""
        return self.bench is not None and self.bench is not threading.current_thread()

    @property
    def solo(self) -> bool:
        """Whether the present thread is the only one that has used the channel."""
        return len(self.visitors) == 1 and threading.get_ident() in self.visitors

    @property
    def crowded(self) -> bool:
        """Whether another thread that uses the channel is alive."""
        present = threading.current_thread()
        return any(thread is not present and thread.is_alive() for thread in self.visitors.values())

    def visit(self) -> None:
        """Notes that the present thread uses the channel."""
        self.visitors[threading.get_ident()] = threading.current_thread()

    def tell(self) -> None:
        """Wakes threads that wait for something to arrive."""
        if self.waiting:
            with self.lock:
                self.changed.notify_all()


_channels: dict[str, Channel] = {}
_lock = threading.Lock()


@contextmanager
def lend(name: str, wire: Wire) -> Iterator[None]:
    """Offers a bench's wire as channel `name`; BusError if the channel is open already."""
    with _lock:
        if name in _channels:
            raise BusError(f"channel {name!r} of interface hilbed is in use: close its buses or name another")
        _channels[name] = Channel(wire, threading.current_thread())
    try:
        yield
    finally:
        with _lock:
            del _channels[name]


def names() -> list[str]:
    """Returns the names of the open channels."""
    return sorted(_channels)


def join(name: str, bitrate: int | None, on_frame: Listener) -> tuple[Channel, Port]:
    """Adds a node to a channel, which is made at 500 kbit/s by default if it is not there.

    BusError where the bit rate is impossible or not the one that the channel has.
    """
    with _lock:
        channel = _channels.get(name)
        if channel is None:
            wire = Wire(bitrate or 500_000)
            wire.advance(0)
            channel = _channels[name] = Channel(wire)
        if bitrate not in (None, channel.wire.bitrate):
            raise BusError(f"channel {name!r} runs at {channel.wire.bitrate} bit/s, not at {bitrate}")
        channel.users += 1
    with channel.lock:
        channel.visit()
        port = channel.wire.attach(f"{name}-{channel.users}", on_frame)
    if channel.elsewhere:
        channel.wire.later(channel.wire.refilter)  # what was worked out meanwhile lacks the new node
    return channel, port


def leave(name: str, channel: Channel, port: Port) -> None:
    """Takes a node off; a channel that is not lent goes with its last bus."""
    if channel.elsewhere:
        channel.wire.later(lambda: channel.wire.detach(port))
    else:
        with channel.lock:
            channel.wire.detach(port)
    with _lock:
        channel.users -= 1
        if channel.bench is None and channel.users == 0:
            del _channels[name]
