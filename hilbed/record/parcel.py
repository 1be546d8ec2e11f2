"""Batches on their way to another process: a pickle of plain tuples, images and columns as they are.

Pickled as they stand, the named tuples of a batch would take longer than to write the logs.
"""

from __future__ import annotations

import pickle
from collections.abc import Sequence
from struct import Struct
from typing import IO, Any, TypeAlias

from hilbed.record.row import Batch, Row, Witnessed
from hilbed.types import DriveSignals, Frame, Innovation, Nanos, Reading, Snapshot, Transfer

Piece: TypeAlias = bytes | memoryview

_COUNT = Struct("<I")
_SIZE = Struct("<Q")


def packed(batch: Batch) -> list[Piece]:
    """Returns a batch as what is to be written to a stream, its clouds left out."""
    buffers: list[pickle.PickleBuffer] = []
    pieces: list[Piece] = [pickle.dumps(_plain(batch), protocol=5, buffer_callback=buffers.append)]
    pieces += [buffer.raw() for buffer in buffers]
    sizes = [_SIZE.pack(len(piece)) for piece in pieces]
    return [_COUNT.pack(len(pieces)) + b"".join(sizes), *pieces]


def receive(stream: IO[bytes]) -> Batch | None:
    """Returns the next batch of a stream; None where it ends, be it in the middle of a batch."""
    head = stream.read(_COUNT.size)
    if len(head) < _COUNT.size:
        return None
    (count,) = _COUNT.unpack(head)
    sizes = stream.read(count * _SIZE.size)
    if len(sizes) < count * _SIZE.size:
        return None
    pieces = [stream.read(size) for (size,) in _SIZE.iter_unpack(sizes)]
    if sum(map(len, pieces)) < sum(size for (size,) in _SIZE.iter_unpack(sizes)):
        return None
    return _batch(pickle.loads(pieces[0], buffers=pieces[1:]))


def _plain(batch: Batch) -> tuple[Any, ...]:
    rows = [
        (t, numbers, [(name, *signals) for name, signals in drives.items()], [*map(tuple, innovations)])
        for t, numbers, drives, innovations, _ in batch.rows
    ]
    transfers = [
        (queued, start, end, *frame, node, error)
        for queued, start, end, frame, node, error in batch.transfers
    ]
    readings = [(tuple(reading), beacon, true) for reading, beacon, true in batch.readings]
    return rows, transfers, readings, [*map(tuple, batch.snapshots)], [*map(dict, batch.ticks)]


def _batch(plain: tuple[Any, ...]) -> Batch:
    rows, transfers, readings, snapshots, ticks = plain
    return Batch(
        [_row(*row) for row in rows],
        [
            Transfer(queued, start, end, Frame(identifier, data, extended, remote), node, error)
            for queued, start, end, identifier, data, extended, remote, node, error in transfers
        ],
        [Witnessed(Reading(*reading), beacon, true) for reading, beacon, true in readings],
        [Snapshot(*snapshot) for snapshot in snapshots],
        ticks,
    )


def _row(t: Nanos, numbers: list[float], drives: Sequence[Any], innovations: Sequence[Any]) -> Row:
    signals = {name: DriveSignals(*values) for name, *values in drives}
    return Row(t, numbers, signals, tuple(Innovation(*one) for one in innovations))
