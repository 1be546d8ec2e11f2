"""Frames in words: by a DBC, by the drives of a scenario, or by one drive table for every node heard."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

import cantools
from cantools.database.can import Database, Message, Signal

from hilbed.can import cia402, emergency
from hilbed.can.dbc import database
from hilbed.can.drive_table import DriveTable
from hilbed.can.node import Node
from hilbed.types import Frame, ScenarioError

_HEX = ("controlword", "statusword", "code", "register", "maker", "command", "index", "subindex", "data")
_KNOWN_NODES = range(1, 128)
_FORMATS = ("arxml", "kcd", "sym")


class Spoken(NamedTuple):
    """A frame in words: name of its message and its content; both raw where nobody knows it."""

    name: str
    content: str


class Decoder:
    """Decodes by the messages given; with a table, nodes are added as they are heard."""

    def __init__(self, known: Database, table: DriveTable | None = None) -> None:
        self._table = table
        self._messages: dict[tuple[int, bool], Message] = {}
        self._add(known.messages)

    def decode(self, frame: Frame) -> Spoken:
        """Returns a frame in words; a frame of any content is survived."""
        key = frame.id, frame.extended
        message = self._messages.get(key)
        node = frame.id & 0x7F
        if message is None and self._table is not None and node in _KNOWN_NODES and not frame.extended:
            self._add(database([Node(f"node{node}", node, self._table)]).messages)
            message = self._messages.get(key)
        name = message.name if message else f"{frame.id:0{8 if frame.extended else 3}X}"
        if frame.remote:
            return Spoken(name, "remote request")
        if message is None:
            return Spoken(name, frame.data.hex(" ").upper())
        if len(frame.data) < message.length:
            raw = frame.data.hex(" ").upper()
            return Spoken(
                name, f"{raw} (shorter than its mapping, {len(frame.data)} of {message.length} bytes)"
            )
        return Spoken(name, _content(message, frame.data))

    def _add(self, messages: Iterable[Message]) -> None:
        for message in messages:
            self._messages.setdefault((message.frame_id, message.is_extended_frame), message)


def _content(message: Message, data: bytes) -> str:
    values = message.decode(data[: message.length])
    assert isinstance(values, dict)
    signals = sorted(message.signals, key=lambda signal: signal.start)
    return "  ".join(f"{signal.name}={_value(signal, values[signal.name])}" for signal in signals)


def _value(signal: Signal, value: object) -> str:
    unit = f" {signal.unit}" if signal.unit else ""
    if isinstance(value, float):
        return f"{value:.5g}{unit}"
    word = signal.name.rpartition("_")[2]
    if isinstance(value, int) and word in _HEX:
        return f"{value:0{signal.length // 4}X}{_meaning(word, value)}"
    return f"{value}{unit}"


def _meaning(word: str, value: int) -> str:
    if word == "statusword":
        return f" ({cia402.state_of(value)})"
    if word == "code" and value:
        return f" ({emergency.meaning(value)})"
    return ""


def read_dbc(path: Path) -> Database:
    """Reads a DBC file (or another format that cantools knows); ScenarioError where it is none."""
    try:
        kind = path.suffix[1:].lower()
        found = cantools.database.load_file(path, kind if kind in _FORMATS else "dbc")
    except OSError as error:
        raise ScenarioError(f"{path}: {error.strerror}") from None
    except Exception as error:  # a parser may raise anything
        reason = " ".join(str(error).split())
        raise ScenarioError(f"{path}: not a DBC: {reason[:200]}") from None
    if not isinstance(found, Database):
        raise ScenarioError(f"{path}: holds no CAN messages")
    return found
