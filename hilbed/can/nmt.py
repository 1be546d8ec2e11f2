"""Network management and heartbeat, both ends (CiA 301)."""

from __future__ import annotations

from hilbed.can.cob import HEARTBEAT, NMT
from hilbed.ports import Bus
from hilbed.types import Frame, Nanos, Received

START, STOP, ENTER_PREOPERATIONAL, RESET_NODE, RESET_COMMUNICATION = 0x01, 0x02, 0x80, 0x81, 0x82

BOOT_UP, STOPPED, OPERATIONAL, PREOPERATIONAL = 0x00, 0x04, 0x05, 0x7F
STATE_NAMES = {
    BOOT_UP: "boot-up",
    STOPPED: "stopped",
    OPERATIONAL: "operational",
    PREOPERATIONAL: "pre-operational",
}


def command(specifier: int, node: int) -> Frame:
    """Returns the master's command to a node (0: to all)."""
    return Frame(NMT, bytes((specifier, node)))


class HeartbeatProducer:
    """Sends a node's state every `period` ns: the first at the first tick, then on a fixed grid."""

    def __init__(self, bus: Bus, node: int, period: Nanos) -> None:
        self._bus = bus
        self._frame = Frame(HEARTBEAT + node, bytes((OPERATIONAL,)))
        self._period = period
        self._due: Nanos | None = None

    def tick(self, t: Nanos) -> None:
        """Sends the heartbeat if it is due."""
        due = t if self._due is None else self._due
        if t >= due:
            self._bus.send(t, self._frame)
            self._due = max(due + self._period, t)


class HeartbeatConsumer:
    """Hears in which state each node says it is, and how often it has booted."""

    def __init__(self) -> None:
        self.states: dict[int, int] = {}
        self.boots: dict[int, int] = {}

    def hear(self, received: Received) -> None:
        """Takes any frame; heeds those of one byte from 0x701 to 0x77F."""
        identifier, data, extended, remote = received.frame
        if extended or remote or not HEARTBEAT < identifier <= HEARTBEAT + 127 or len(data) != 1:
            return
        node, state = identifier - HEARTBEAT, data[0] & 0x7F  # bit 7 is node guarding's toggle
        self.states[node] = state
        if state == BOOT_UP:
            self.boots[node] = self.boots.get(node, 0) + 1
