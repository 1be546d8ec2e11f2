"""A few camera frames of the run for its report, evenly spread over it."""

from __future__ import annotations

import json
from pathlib import Path

from hilbed.record.disk import RecordError
from hilbed.record.folder import write_whole
from hilbed.record.row import Batch
from hilbed.types import Snapshot

INDEX = "frames.jsonl"


class Frames:
    """A sink that keeps between `most` / 2 and `most` frames, whatever the length of the run.

    When there are too many, every second one is dropped and from then on half as many are kept; `most` is
    even. On `close` they become PNG files in `folder`, with one JSON line each in `frames.jsonl`:
    t (s), file, pan (rad), pixels and beacons of the detections.
    """

    def __init__(self, folder: Path, most: int = 12) -> None:
        self._folder = folder
        self._most = most
        self._every = 1
        self._count = 0
        self._kept: list[Snapshot] = []

    def take(self, batch: Batch) -> None:
        for snapshot in batch.snapshots:
            if self._count % self._every == 0:
                self._keep(snapshot)
            self._count += 1

    def _keep(self, snapshot: Snapshot) -> None:
        self._kept.append(snapshot)
        if len(self._kept) > self._most:
            self._kept = self._kept[::2]
            self._every *= 2

    def close(self) -> None:
        """Writes the frames; raises RecordError if the disk is full."""
        if not self._kept:
            return
        try:
            self._folder.mkdir(exist_ok=True)
            lines = [_write(self._folder, k, snapshot) for k, snapshot in enumerate(self._kept)]
            (self._folder / INDEX).write_text("".join(lines))
        except OSError as error:
            raise RecordError(f"{self._folder}: {error.strerror}") from error
        finally:
            self._kept = []


def _write(folder: Path, k: int, snapshot: Snapshot) -> str:
    import cv2

    name = f"{k:02d}.png"
    _, data = cv2.imencode(".png", snapshot.image[:, :, ::-1])
    write_whole(folder / name, data.tobytes())
    entry = {
        "t": snapshot.t / 1e9,
        "file": name,
        "pan": snapshot.pan,
        "pixels": list(snapshot.pixels),
        "beacons": list(snapshot.beacons),
    }
    return json.dumps(entry) + "\n"
