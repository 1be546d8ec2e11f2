"""Who is on a bus: objects are read, nothing is written, no node changes its state."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from hilbed.can import cia402, emergency, nmt
from hilbed.can.cob import SDO_ANSWER, SDO_REQUEST
from hilbed.can.drive_table import bundled_tables, load_table
from hilbed.can.link import Link, Pump
from hilbed.can.sdo import UPLOAD, SdoClient, SdoError
from hilbed.clock import MILLISECOND, NEVER
from hilbed.ports import Bus
from hilbed.types import Frame, Nanos, Received

NODES = range(1, 128)
PACE: Nanos = 2 * MILLISECOND
"""Between two questions: at 125 kbit/s they and their answers take the bus for 2 ms."""
PATIENCE: Nanos = 200 * MILLISECOND
DRIVE_PROFILE = 402


class Found(NamedTuple):
    """A node; None where it does not say.

    state: NMT, by its heartbeat; power: of CiA 402; table: whose identity it has; trouble: in words.
    """

    node: int
    device_type: int | None = None
    vendor: int | None = None
    product: int | None = None
    revision: int | None = None
    serial: int | None = None
    name: str | None = None
    state: str | None = None
    power: str | None = None
    error: int | None = None
    table: str | None = None
    trouble: str = ""

    def as_dict(self) -> dict[str, Any]:
        return {key: value for key, value in self._asdict().items() if value not in (None, "")}


def scan(bus: Bus, pump: Pump, listen: Nanos, start: Nanos = 0) -> list[Found]:
    """Listens, asks every node number for its device type, and those that answer for what they are.

    A node that only sends heartbeats is found as well. Raises BusError where the bus is lost.
    """
    bus.recv(start)
    link = Link(bus, pump, start, NEVER)
    heartbeats = nmt.HeartbeatConsumer()
    answers: dict[int, list[bytes]] = {}
    link.listeners += [heartbeats.hear, lambda received: _note(answers, received)]
    link.pause(listen)
    for node in NODES:
        link.send(Frame(SDO_REQUEST + node, bytes((UPLOAD, 0x00, 0x10, 0, 0, 0, 0, 0))))
        link.pause(PACE)
    link.pause(PATIENCE)
    present = sorted({*answers, *heartbeats.states})
    return [_identified(link, node, answers.get(node, []), heartbeats) for node in present]


def _note(answers: dict[int, list[bytes]], received: Received) -> None:
    identifier, data, extended, remote = received.frame
    node = identifier - SDO_ANSWER
    about = data[1:4] == b"\x00\x10\x00"
    if node in NODES and len(data) == 8 and about and not extended and not remote:
        answers.setdefault(node, []).append(data)


def _identified(link: Link, node: int, answers: Sequence[bytes], heard: nmt.HeartbeatConsumer) -> Found:
    state = nmt.STATE_NAMES.get(heard.states[node], "unknown") if node in heard.states else None
    found = Found(node, state=state)
    if not answers:
        return found._replace(trouble="answers no SDO")
    if len(answers) > 1:
        return found._replace(trouble=f"{len(answers)} nodes answer to this number")
    sdo = _Reader(link, node)
    found = found._replace(
        device_type=sdo.number(0x1000),
        vendor=sdo.number(0x1018, 1),
        product=sdo.number(0x1018, 2),
        revision=sdo.number(0x1018, 3),
        serial=sdo.number(0x1018, 4),
        name=sdo.text(0x1008),
    )
    found = found._replace(table=_table(found))
    if found.device_type is None or found.device_type & 0xFFFF != DRIVE_PROFILE:
        return found
    statusword = sdo.number(0x6041)
    power = None if statusword is None else cia402.state_of(statusword & 0xFFFF)
    return found._replace(power=power, error=sdo.number(0x603F) or None)


class _Reader:
    """Reads objects of a node; None for what it does not have or does not answer."""

    def __init__(self, link: Link, node: int) -> None:
        self._sdo = SdoClient(link, "", node)

    def data(self, index: int, sub: int = 0) -> bytes | None:
        try:
            return self._sdo.upload(index, sub)
        except SdoError:
            return None

    def number(self, index: int, sub: int = 0) -> int | None:
        data = self.data(index, sub)
        return None if data is None else int.from_bytes(data, "little")

    def text(self, index: int) -> str | None:
        data = self.data(index)
        return None if data is None else data.rstrip(b"\0").decode("utf-8", errors="replace")


def _table(found: Found) -> str | None:
    """Returns the bundled drive table whose identity a node has."""
    identity = (found.device_type, found.vendor, found.product)
    for name in bundled_tables():
        known = load_table(name).identity
        if (known.device_type, known.vendor, known.product) == identity:
            return name
    return None


def table_of(found: Sequence[Found]) -> str:
    """Returns nodes as lines of text."""
    if not found:
        return "no node found: is anything powered and wired, with this bit rate?"
    return "\n".join(_line(node) for node in found)


def _line(found: Found) -> str:
    parts = [f"node {found.node:3d}"]
    if found.trouble:
        parts.append(found.trouble)
    if found.name:
        parts.append(found.name)
    if found.device_type is not None:
        parts.append(f"device type {found.device_type:08X}")
    numbers = (found.vendor, found.product, found.revision, found.serial)
    if any(number is not None for number in numbers):
        parts.append("identity " + ":".join("-" if n is None else f"{n:X}" for n in numbers))
    if found.table:
        parts.append(f"table {found.table}")
    parts.append(found.state or "no heartbeat")
    if found.power:
        parts.append(found.power)
    if found.error:
        parts.append(f"error {found.error:04X}: {emergency.meaning(found.error & 0xFFFF)}")
    return "  ".join(parts)
