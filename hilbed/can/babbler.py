"""A stranger on the bus that does not stop sending."""

from __future__ import annotations

from hilbed.can.wire import Wire
from hilbed.effects import Babble
from hilbed.types import Frame, Nanos

_CONTENT = bytes(range(8))


class Babbler:
    """A node that sends the same frame again and again, as soon as the one before is through if need be.

    begun: when; sent: frames that were.
    """

    def __init__(self, t: Nanos, wire: Wire, babble: Babble) -> None:
        self.begun, self.sent = t, 0
        self._wire = wire
        self._period = babble.period
        self._due = t
        self._frame = Frame(babble.identifier, _CONTENT)
        self._port = wire.attach("babbler", _deaf)
        self._port.listen(on_sent=self._next)
        self._port.send(t, self._frame)

    def stop(self) -> None:
        """Leaves the bus; a frame that is on it is finished."""
        self._port.listen()
        self._port.empty()
        self._wire.detach(self._port)

    def _next(self, t: Nanos, _: Frame) -> None:
        self.sent += 1
        self._due = max(self._due + self._period, t)
        self._port.send(self._due, self._frame)


def _deaf(_: Nanos, frame: Frame) -> None:
    """Hears nothing."""
