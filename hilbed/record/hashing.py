"""Fingerprints of a run: equal if, and only if, the same things happened at the same times."""

from __future__ import annotations

from collections.abc import Mapping
from hashlib import sha256
from struct import Struct
from typing import Any

import numpy as np
import numpy.typing as npt

from hilbed.record.row import Batch

# queued, start, end, identifier, extended, remote, bytes of data, bytes of the node's name
_FRAME = Struct("<qqqI??BB").pack

BUS_PREFIX = "bus/"
WALL_PREFIX = "realtime/"
"""Columns that tell of the wall clock, which is in no fingerprint."""


class BusDigest:
    """A sink that digests every frame, times and content, as it comes by."""

    def __init__(self) -> None:
        self._sha = sha256()

    def take(self, batch: Batch) -> None:
        if not batch.transfers:
            return
        pieces: list[bytes] = []
        for queued, start, end, (identifier, data, extended, remote), node, error in batch.transfers:
            name = node.encode() + bytes((0, error)) if error else node.encode()
            head = _FRAME(queued, start, end, identifier, extended, remote, len(data), len(name))
            pieces += (head, data, name)
        self._sha.update(b"".join(pieces))

    def close(self) -> None:
        """Has nothing to close."""

    def digest(self) -> bytes:
        """Returns the digest of all frames so far."""
        return self._sha.digest()


def run_hash(signals: Mapping[str, npt.NDArray[Any]], bus: bytes) -> str:
    """Returns the SHA-256, in hex, over all signals and the digest of the bus."""
    sha = sha256(_digest(signals, list(signals)))
    sha.update(bus)
    return sha.hexdigest()


def signals_hash(signals: Mapping[str, npt.NDArray[Any]]) -> str:
    """Returns the SHA-256, in hex, over the signals that do not come from the timing of the bus."""
    return _digest(signals, [name for name in signals if not name.startswith(BUS_PREFIX)]).hex()


def _digest(signals: Mapping[str, npt.NDArray[Any]], names: list[str]) -> bytes:
    sha = sha256()
    for name in sorted(name for name in names if not name.startswith(WALL_PREFIX)):
        array = _canonical(signals[name])
        sha.update(f"{name} {array.dtype.str} {array.shape}\n".encode())
        sha.update(array.tobytes())
    return sha.digest()


def _canonical(array: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Returns the array little-endian, in C order, with a single pattern of bits for NaN."""
    array = np.ascontiguousarray(array, dtype=array.dtype.newbyteorder("<"))
    if array.dtype.kind == "f":
        array = np.where(np.isnan(array), np.nan, array)
    return array
