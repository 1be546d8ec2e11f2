"""A python-can bus of the same process joins a running bench by `bus.channel`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import can
import pytest

from hilbed.can import channels
from hilbed.clock import SECOND
from hilbed.record.folder import RunFolder
from hilbed.runner import Watch, perform
from hilbed.scenario.load import load
from hilbed.types import Cycle

SETTINGS = ["duration=0.5", "bus.channel=guests"]


class Guest:
    """Joins at the first cycle, listens at each, and says something once."""

    def __init__(self, says: can.Message | None = None) -> None:
        self.bus: can.BusABC | None = None
        self.heard: list[can.Message] = []
        self._says = says

    def __call__(self, cycle: Cycle) -> None:
        if self.bus is None:
            self.bus = can.Bus(interface="hilbed", channel="guests")
        while (message := self.bus.recv(0)) is not None:
            self.heard.append(message)
        if self._says is not None and cycle.t >= SECOND // 4:
            self.bus.send(self._says)
            self._says = None


@pytest.fixture
def visited(tmp_path: Path) -> Callable[[Guest], list[can.Message]]:
    def visit(guest: Guest) -> list[can.Message]:
        loaded = load("slimane2014/load-torque", SETTINGS)
        outcome = perform(loaded, RunFolder(tmp_path / "run"), Watch(cycle=guest))
        assert outcome.status < 2, outcome.verdict["reason"]
        assert guest.bus is not None
        guest.bus.shutdown()
        return list(can.LogReader(tmp_path / "run" / "can.log"))

    return visit


def content(message: can.Message, late: float = 0.0) -> tuple[float, int, bytes]:
    """Returns time since t = 0 in µs, identifier and data."""
    return round((message.timestamp - late) * 1e6), message.arbitration_id, bytes(message.data)


def test_it_hears_every_frame_when_it_was_sent(visited: Callable[[Guest], list[can.Message]]) -> None:
    guest = Guest()
    log = [content(message, late=1.0) for message in visited(guest)]
    heard = [content(message) for message in guest.heard]
    first, last = log.index(heard[0]), log.index(heard[-1])
    assert heard == log[first : last + 1]
    assert sum(identifier == 0x80 for _, identifier, _ in heard) == 49  # one SYNC a cycle, the first unheard
    assert {0x181, 0x182} <= {identifier for _, identifier, _ in heard}
    assert heard[-1][0] <= 500_000


def test_what_it_sends_is_on_the_wire_and_answered(visited: Callable[[Guest], list[can.Message]]) -> None:
    """An SDO upload of the left drive's device type, as any configuration tool would ask for."""
    ask = can.Message(arbitration_id=0x601, data=bytes.fromhex("4000100000000000"), is_extended_id=False)
    guest = Guest(ask)
    log = visited(guest)
    asked = [m for m in log if m.arbitration_id == 0x601 and bytes(m.data) == bytes(ask.data)]
    assert [round(m.timestamp, 1) for m in asked if m.timestamp > 1.0] == [1.3]
    (answer,) = [m for m in guest.heard if m.arbitration_id == 0x581]
    assert bytes(answer.data).startswith(bytes.fromhex("43001000"))
    assert int.from_bytes(answer.data[4:6], "little") == 402


def test_the_channel_is_given_back() -> None:
    for _ in range(2):
        assert perform(load("slimane2014/load-torque", SETTINGS), None).status < 2
        assert channels.names() == []
