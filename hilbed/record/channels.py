"""The topics of an MCAP file."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from hilbed.record import messages
from hilbed.record.disk import GrowingFile
from hilbed.types import Array, Nanos

Log = Callable[[bytes, Nanos], None]


class Channels:
    """The topics of one MCAP file, each made when it is first wanted."""

    def __init__(self, file: GrowingFile) -> None:
        import foxglove
        from foxglove.mcap import MCAPCompression, MCAPWriteOptions

        self._context = foxglove.Context()
        self._logs: dict[str, Callable[..., None]] = {}
        self._channels: list[Any] = []
        options = MCAPWriteOptions(
            compression=MCAPCompression.Lz4,  # a quarter larger than with zstd, for a third of its time
            chunk_size=1 << 22,  # a chunk ends where we flush it
            disable_seeking=True,  # so that a chunk reaches the file in one piece
            compression_threads=0,  # threads would win nothing and cost the other runs of a sweep
        )
        self._writer = foxglove.open_mcap(file, context=self._context, writer_options=options)

    def ros(self, topic: str, definition: messages.Definition) -> Log:
        """Returns the function that logs a packed message (bytes, log time) on a topic."""
        from foxglove import Channel, Schema

        schema = Schema(name=definition.name, encoding="ros2msg", data=definition.text.encode())
        channel = Channel(topic, message_encoding="cdr", schema=schema, context=self._context)
        self._channels.append(channel)
        log: Log = channel.base.log
        return log

    def numbers(self, topic: str, name: str, groups: messages.Groups) -> Callable[..., None]:
        """Returns the function that logs numbers, (log time, *values), on a topic."""
        if topic not in self._logs:
            definition, pack = messages.numbers(name, groups)
            self._logs[topic] = partial(_log_numbers, self.ros(topic, definition), pack)
        return self._logs[topic]

    def rows(self, topic: str, name: str, groups: messages.Groups) -> Callable[..., None]:
        """Returns the function that logs many rows, (log times (n,), values (n, m)), on a topic."""
        if topic not in self._logs:
            definition, _ = messages.numbers(name, groups)
            self._logs[topic] = partial(_log_rows, self.ros(topic, definition))
        return self._logs[topic]

    def typed(self, topic: str, name: str) -> Callable[..., None]:
        """Returns the function that logs one of Foxglove's own messages on a topic."""
        if topic not in self._logs:
            from foxglove import channels

            channel = getattr(channels, f"{name}Channel")(topic, context=self._context)
            self._channels.append(channel)
            self._logs[topic] = channel.log
        return self._logs[topic]

    def attach(self, name: str, text: str) -> None:
        self._writer.attach(
            log_time=0, create_time=0, name=name, media_type="application/yaml", data=text.encode()
        )

    def flush(self) -> None:
        self._writer.flush()

    def close(self) -> None:
        self._writer.close()
        for channel in self._channels:
            channel.close()


def _log_numbers(log: Log, pack: Callable[..., bytes], stamp: Nanos, *values: float) -> None:
    log(pack(*values), stamp)


def _log_rows(log: Log, stamps: np.ndarray, values: Array) -> None:
    log_packed(log, stamps, messages.number_messages(values))


def log_packed(log: Log, stamps: np.ndarray, table: np.ndarray) -> None:
    """Logs every element of a structured array (n,) as a message at its log time (ns)."""
    packed, size = table.tobytes(), table.dtype.itemsize
    for k, stamp in enumerate(stamps.tolist()):
        log(packed[k * size : (k + 1) * size], stamp)
