"""can.log: every frame of the bus in the format of `candump -L`."""

from __future__ import annotations

from pathlib import Path

from hilbed.clock import SECOND
from hilbed.record.disk import GrowingFile
from hilbed.record.row import Batch
from hilbed.types import ACK_ERROR, BIT_ERROR, Nanos, Transfer

ERROR_FRAMES = {
    BIT_ERROR: ("20000088", "0000010000000000"),  # bus error, protocol violation: single bit
    ACK_ERROR: ("200000A0", "0000000000000000"),  # bus error, no acknowledgement
}
"""Identifier with the bits that tell the class of error, and data, of Linux's error frames."""


class CandumpLog:
    """A sink that writes `(seconds.microseconds) channel ID#DATA`, stamped with a frame's last bit.

    Boot happens before t = 0 and the format knows no negative time, so the log's time is t + `offset`;
    whole seconds keep it readable. Every batch goes to the disk, in whole lines only.
    """

    def __init__(self, path: Path, offset: Nanos = 0, channel: str = "hilbed") -> None:
        self._file = GrowingFile(path)
        self._offset = offset
        self._channel = channel

    def take(self, batch: Batch) -> None:
        offset, channel = self._offset, self._channel
        if batch.transfers:
            lines = [line(transfer, offset, channel) for transfer in batch.transfers]
            self._file.write("".join(lines).encode())
            self._file.flush()
            self._file.check()

    def close(self) -> None:
        self._file.close()


def line(transfer: Transfer, offset: Nanos, channel: str) -> str:
    """Returns one line of the log; a frame that ended before −`offset` is stamped 0.

    An error frame looks as Linux reports one, without the frame that it has cut off.
    """
    seconds, rest = divmod(max(transfer.end + offset, 0), SECOND)
    identifier, data, extended, remote = transfer.frame
    name = f"{identifier:08X}" if extended else f"{identifier:03X}"
    content = "R" if remote else data.hex().upper()
    if transfer.error:
        name, content = ERROR_FRAMES[transfer.error]
    return f"({seconds}.{rest // 1000:06d}) {channel} {name}#{content}\n"
