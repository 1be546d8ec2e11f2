from __future__ import annotations

import json
from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed.record.frames import INDEX, Frames
from hilbed.record.row import Batch
from hilbed.types import Snapshot
from tests.record.runs import image


def seen(frames: Frames, count: int) -> None:
    shots = [Snapshot(k * 100_000_000, image(k), 0.0, (1.5,), (None,)) for k in range(count)]
    frames.take(Batch((), (), (), shots, ()))


@given(st.integers(1, 300))
def test_a_few_frames_are_kept_evenly_spread(count: int) -> None:
    frames = Frames(Path("unused"), most=8)
    seen(frames, count)
    times = [shot.t for shot in frames._kept]
    assert min(count, 4) <= len(times) <= 8
    assert len(set(np.diff(times))) <= 1
    assert times[0] == 0


def test_frames_are_written_as_they_were_seen(tmp_path: Path) -> None:
    frames = Frames(tmp_path / "frames")
    seen(frames, 5)
    frames.close()
    entries = [json.loads(line) for line in (tmp_path / "frames" / INDEX).read_text().splitlines()]
    assert [entry["t"] for entry in entries] == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.4])
    assert entries[3]["pixels"] == [1.5]
    assert entries[3]["beacons"] == [None]
    picture = cv2.imread(str(tmp_path / "frames" / entries[3]["file"]))
    assert picture is not None
    assert (picture[:, :, ::-1] == image(3)).all()


def test_without_a_camera_there_is_no_folder(tmp_path: Path) -> None:
    Frames(tmp_path / "frames").close()
    assert list(tmp_path.iterdir()) == []
