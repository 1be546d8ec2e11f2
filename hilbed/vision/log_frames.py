"""The camera frames of a recorded run, from its log.mcap, to be shown to a detector again."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from hilbed.types import Nanos, ScenarioError
from hilbed.vision.lens import Lens
from hilbed.vision.seams import Shot

TOPIC = "/camera/image"
_ENCODING = "rgb8"
_VARINT, _FIXED64, _BYTES, _FIXED32 = 0, 1, 2, 5
_WIDTH, _HEIGHT, _CODE, _DATA = 2, 3, 4, 6  # fields of foxglove.RawImage


class LogFrames:
    """Every frame that a run's camera exposed, at the time of its exposure.

    lens: of the run's camera; offset: ns that the log's times are ahead of the run's. Raises ScenarioError
    where there is no log, no package `mcap` to read it, no frame in it, or one of another size.
    """

    def __init__(self, path: Path, lens: Lens, offset: Nanos) -> None:
        try:
            import mcap.reader  # noqa: F401
        except ModuleNotFoundError:
            raise ScenarioError(
                f"{path} is read by the package mcap, which is not installed: pip install mcap; "
                f"{path.parent / 'frames'} holds a few of its frames as images"
            ) from None
        if not path.is_file():
            raise ScenarioError(f"there is no file {path}: only a run with record: all has its frames")
        self.name, self.lens = str(path), lens
        self._path, self._offset = path, offset

    def frames(self) -> Iterator[Shot]:
        """Yields the frames in the order of the log."""
        count = 0
        for t, data in self._messages():
            count += 1
            yield Shot(self._image(data), t - self._offset, self.lens)
        if not count:
            raise ScenarioError(f"{self.name}: there is no frame in it")

    def close(self) -> None:
        """Holds nothing between two frames."""

    def _messages(self) -> Iterator[tuple[Nanos, bytes]]:
        from mcap.exceptions import McapError
        from mcap.reader import NonSeekingReader

        with self._path.open("rb") as stream:
            try:
                for _, _, message in NonSeekingReader(stream).iter_messages([TOPIC], log_time_order=False):
                    yield message.log_time, message.data
            except (McapError, struct.error, RuntimeError) as error:  # cut off between, or inside, records
                raise ScenarioError(f"{self.name}: is cut off, or is no MCAP: {error!r}") from None

    def _image(self, data: bytes) -> Any:
        fields = dict(_fields(data))
        size = (fields.get(_WIDTH), fields.get(_HEIGHT))
        if size != (self.lens.width, self.lens.height) or fields.get(_CODE) != _ENCODING.encode():
            told = f"{size[0]}×{size[1]} pixels; the run's camera has {self.lens.width}×{self.lens.height}"
            raise ScenarioError(f"{self.name}: a frame has {told}")
        image = np.frombuffer(fields[_DATA], np.uint8)
        return image.reshape(self.lens.height, self.lens.width, 3)


def _fields(data: bytes) -> Iterator[tuple[int, Any]]:
    """Yields the fields of a protobuf message with their numbers; numbers are of 32 or 64 bits, unsigned."""
    at = 0
    while at < len(data):
        tag, at = _varint(data, at)
        field, wire = tag >> 3, tag & 7
        if wire == _VARINT:
            value, at = _varint(data, at)
            yield field, value
            continue
        size, at = (8, at) if wire == _FIXED64 else (4, at) if wire == _FIXED32 else _varint(data, at)
        piece = data[at : at + size]
        yield field, piece if wire == _BYTES else int.from_bytes(piece, "little")
        at += size


def _varint(data: bytes, at: int) -> tuple[int, int]:
    value = shift = 0
    while True:
        byte = data[at]
        value |= (byte & 0x7F) << shift
        at, shift = at + 1, shift + 7
        if byte < 0x80:
            return value, at
