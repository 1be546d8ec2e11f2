from __future__ import annotations

import errno
import os
from pathlib import Path

import numpy as np
import pytest

from hilbed.record.disk import RecordError
from hilbed.record.folder import RunFolder
from hilbed.types import ScenarioError


def finished(path: Path) -> Path:
    folder = RunFolder(path)
    folder.start()
    folder.write("scenario.yaml", "seed: 1\n")
    folder.write_verdict("{}")
    (path / "frames").mkdir()
    (path / "frames" / "00.png").write_bytes(b"png")
    return path


def test_looking_touches_nothing(tmp_path: Path) -> None:
    RunFolder(tmp_path / "runs" / "demo-1")
    assert list(tmp_path.iterdir()) == []


def test_an_existing_run_is_replaced_only_by_force_and_only_at_the_start(tmp_path: Path) -> None:
    path = finished(tmp_path / "demo-1")
    with pytest.raises(ScenarioError, match="--force"):
        RunFolder(path)
    folder = RunFolder(path, force=True)
    assert (path / "verdict.json").exists()
    folder.start()
    assert not {"scenario.yaml", "verdict.json", "frames"} & {entry.name for entry in path.iterdir()}


def test_force_removes_runs_and_nothing_else(tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("years of work")
    (tmp_path / "scenario.yaml").write_text("of the user's own")
    with pytest.raises(ScenarioError, match="does not hold a run"):
        RunFolder(tmp_path, force=True)
    killed = RunFolder(tmp_path / "demo-0")
    killed.start()
    RunFolder(tmp_path / "demo-0", force=True).start()
    path = finished(tmp_path / "demo-1")
    (path / "notes.txt").write_text("mine")
    RunFolder(path, force=True).start()
    assert [entry.name for entry in path.iterdir() if entry.name[0] != "."] == ["notes.txt"]


def test_a_place_that_cannot_be_used_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("")
    for bad in (tmp_path / "file", tmp_path / "file" / "demo"):
        with pytest.raises(ScenarioError, match="--out"):
            RunFolder(bad)
    monkeypatch.setattr(os, "access", lambda *_: False)  # root may write everywhere
    with pytest.raises(ScenarioError, match="cannot be written"):
        RunFolder(tmp_path / "demo")


def test_signals_come_back(tmp_path: Path) -> None:
    folder = RunFolder(tmp_path / "demo")
    folder.start()
    folder.write_signals({"t": np.arange(3.0), "drive/left/speed": np.ones(3)})
    with np.load(tmp_path / "demo" / "signals.npz") as signals:
        assert sorted(signals) == ["drive/left/speed", "t"]
        assert signals["t"] == pytest.approx([0.0, 1.0, 2.0])


def test_a_full_disk_leaves_the_old_file_and_no_half_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = RunFolder(tmp_path / "demo")
    folder.start()
    folder.write_verdict("old")

    def full(self: Path, data: bytes) -> int:
        with self.open("wb") as file:
            file.write(data[:1])
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(RecordError, match="No space left"):
        folder.write("verdict.json", "new")
    assert [entry.name for entry in folder.path.iterdir()] == ["verdict.json"]
    assert (folder.path / "verdict.json").read_text() == "old"


def test_the_verdict_has_its_room_on_a_disk_that_is_full(tmp_path: Path) -> None:
    folder = RunFolder(tmp_path / "demo")
    reserve = sum(entry.stat().st_size for entry in folder.start().iterdir())
    assert reserve >= 1 << 16
    folder.write_verdict("told")
    assert [entry.name for entry in folder.path.iterdir()] == ["verdict.json"]
    assert folder.path.joinpath("verdict.json").read_text() == "told"


def test_a_disk_that_is_full_at_the_start_is_left_as_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(self: Path, data: bytes) -> int:
        with self.open("wb") as file:
            file.write(data[:1])
        raise OSError(errno.ENOSPC, "No space left on device")

    folder = RunFolder(tmp_path / "demo")
    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(ScenarioError, match="No space left"):
        folder.start()
    assert list(tmp_path.iterdir()) == []
