"""The channels of the python-can interface "hilbed": wires by name, shared by every bus of this process.

A bench lends its wire while it runs and then owns the time. A channel that nobody lent belongs to the
python-can buses that opened it: whoever receives moves its time on.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from hilbed.can.port import Port
from hilbed.can.wire import Wire
from hilbed.types import BusError


@dataclass
class Channel:
    """A wire, whether a bench moves its time, and how many python-can buses are open on it."""

    wire: Wire
    lent: bool
    users: int = 0


_channels: dict[str, Channel] = {}


@contextmanager
def lend(name: str, wire: Wire) -> Iterator[None]:
    """Offers a bench's wire as channel `name`; BusError if the channel is open already."""
    if name in _channels:
        raise BusError(f"channel {name!r} of interface hilbed is in use: close its buses or name another")
    _channels[name] = Channel(wire, lent=True)
    try:
        yield
    finally:
        del _channels[name]


def names() -> list[str]:
    """Returns the names of the open channels."""
    return sorted(_channels)


def join(name: str, bitrate: int | None) -> tuple[Channel, Port]:
    """Adds a node to a channel, which is made at 500 kbit/s by default if it is not there.

    BusError where the bit rate is impossible or not the one that the channel has.
    """
    channel = _channels.get(name)
    if channel is None:
        wire = Wire(bitrate or 500_000)
        wire.advance(0)
        channel = _channels[name] = Channel(wire, lent=False)
    if bitrate not in (None, channel.wire.bitrate):
        raise BusError(f"channel {name!r} runs at {channel.wire.bitrate} bit/s, not at {bitrate}")
    channel.users += 1
    return channel, channel.wire.attach(f"{name}-{channel.users}")


def leave(name: str, channel: Channel, port: Port) -> None:
    """Takes a node off; a channel that is not lent goes with its last bus."""
    channel.wire.detach(port)
    channel.users -= 1
    if not channel.lent and channel.users == 0:
        del _channels[name]
