"""A python-can driver that does whatever a test tells it to, under the interface name "odd"."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from queue import SimpleQueue
from threading import Event

import can
from can.interface import BACKENDS

from hilbed.can.hardware import Adapter


class OddBus(can.BusABC):
    """on_send: called with every message, may block or raise; what is put into `incoming` is received.

    An exception among the incoming is raised by `recv`.
    """

    def __init__(self, channel: object = None, **options: object) -> None:
        self.channel_info = "odd"
        self.on_send: Callable[[can.Message], None] = lambda _: None
        self.incoming: SimpleQueue[can.Message | Exception] = SimpleQueue()
        self.told = Event()
        self.sent: list[can.Message] = []
        super().__init__(channel=channel, **options)

    def send(self, msg: can.Message, timeout: float | None = None) -> None:  # noqa: ARG002
        self.told.set()
        self.on_send(msg)
        self.sent.append(msg)

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        try:
            message = self.incoming.get(timeout=timeout)
        except Exception:
            return None, True
        if isinstance(message, Exception):
            raise message
        return message, True


@contextmanager
def odd(threads: bool = True) -> Iterator[tuple[Adapter, OddBus]]:
    """Opens an adapter on an odd driver; threads: whether it is one that may make its caller wait."""
    import hilbed.can.hardware as hardware

    valid, prompt = can.util.VALID_INTERFACES, hardware.PROMPT
    BACKENDS["odd"] = (__name__, "OddBus")
    can.util.VALID_INTERFACES = valid | {"odd"}
    hardware.PROMPT = prompt if threads else (*prompt, "odd")
    try:
        adapter = Adapter("odd", "x")
        bus = adapter._driver.bus
        assert isinstance(bus, OddBus)
        yield adapter, bus
        adapter.close()
    finally:
        del BACKENDS["odd"]
        can.util.VALID_INTERFACES, hardware.PROMPT = valid, prompt
