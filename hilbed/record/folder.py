"""The run folder: nothing is touched before the run is sure to start, nothing is left half-written."""

from __future__ import annotations

import os
import shutil
from collections.abc import Mapping
from contextlib import suppress
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from hilbed.record.disk import RecordError
from hilbed.types import ScenarioError

SCENARIO, SIGNALS, MCAP = "scenario.yaml", "signals.npz", "log.mcap"
CAN, VERDICT, REPORT, FRAMES = "can.log", "verdict.json", "report.html", "frames"
DBC, ATTRIBUTION = "bus.dbc", "attribution.json"
FILES, DETECTORS = "files", "detectors"
RESERVE, RESERVED = ".reserve", 1 << 16
CONTENT = (SCENARIO, SIGNALS, MCAP, CAN, DBC, VERDICT, REPORT, ATTRIBUTION, FRAMES, FILES, DETECTORS, RESERVE)


class RunFolder:
    """Where a run writes; constructing it only looks whether that will be possible.

    Raises ScenarioError if the folder exists and `force` is not given, if with `force` it holds something
    but no run (nothing else is ever removed), or if it cannot be written.
    """

    def __init__(self, path: Path, force: bool = False) -> None:
        self.path = path
        try:
            if path.is_symlink() or path.exists():
                _check_existing(path, force)
            _check_writable(path)
        except OSError as error:
            raise ScenarioError(f"{path}: {error.strerror}; give another folder with --out") from error

    def start(self) -> Path:
        """Removes the old run, makes the folder and returns its path; raises ScenarioError if it cannot.

        Room for the verdict is set aside, so that it can be told that the disk was full.
        """
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            for name in CONTENT:
                _remove(self.path / name)
            (self.path / RESERVE).write_bytes(bytes(RESERVED))
        except OSError as error:
            with suppress(OSError):
                _remove(self.path / RESERVE)
                self.path.rmdir()  # where nothing is in it
            raise ScenarioError(f"{self.path}: {error.strerror}") from error
        return self.path

    def write(self, name: str, content: str | bytes) -> None:
        """Writes a file at once or not at all; raises RecordError if it cannot be written."""
        data = content.encode() if isinstance(content, str) else content
        write_whole(self.path / name, data)

    def keep(self, contents: Mapping[str, bytes]) -> None:
        """Writes the scenario's own files, by their paths in the folder; raises RecordError."""
        for name, data in contents.items():
            place = self.path / name
            try:
                place.parent.mkdir(parents=True, exist_ok=True)
            except OSError as error:
                raise RecordError(f"{place}: {error.strerror}") from error
            write_whole(place, data)

    def write_verdict(self, text: str) -> None:
        """Writes verdict.json in the room that was set aside; raises RecordError if it cannot be written."""
        with suppress(OSError):
            _remove(self.path / RESERVE)
        self.write(VERDICT, text)

    def write_signals(self, signals: Mapping[str, np.ndarray[Any, Any]]) -> None:
        """Writes signals.npz; raises RecordError if it cannot be written."""
        buffer = BytesIO()
        np.savez(buffer, **signals)  # type: ignore[arg-type]  # names are data, not options
        write_whole(self.path / SIGNALS, buffer.getvalue())


def write_whole(path: Path, data: bytes) -> None:
    """Writes a file beside its place, then moves it there; raises RecordError and leaves nothing behind."""
    temporary = path.with_name(f".{path.name}.tmp")
    try:
        temporary.write_bytes(data)
        os.replace(temporary, path)
    except OSError as error:
        temporary.unlink(missing_ok=True)
        raise RecordError(f"{path}: {error.strerror}") from error


def _check_existing(path: Path, force: bool) -> None:
    if not path.is_dir():
        raise ScenarioError(f"{path} is not a folder; give another one with --out")
    found = {entry.name for entry in path.iterdir()}
    if not found:
        return
    if not force:
        raise ScenarioError(f"{path} exists; --force replaces the run in it, --out takes another folder")
    if not found & {VERDICT, RESERVE}:  # one of them is there from the first moment of a run on
        raise ScenarioError(f"{path} does not hold a run, so --force does not replace it; give another --out")


def _check_writable(path: Path) -> None:
    """Looks at the folder or, where it does not exist yet, at the nearest folder above that does."""
    place = next(folder for folder in (path, *path.absolute().parents) if folder.exists())
    if not place.is_dir() or not os.access(place, os.W_OK | os.X_OK):
        raise ScenarioError(f"{path}: {place} cannot be written; give another folder with --out")


def _remove(path: Path) -> None:
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)


def check_folder(path: Path) -> bool:
    """Returns whether a folder holds anything; raises ScenarioError where it cannot be made or written to.

    For the time before there is work to be lost. What is tried out for it is taken back.
    """
    try:
        _check_writable(path)
        missing = [place for place in (path, *path.absolute().parents) if not place.exists()]
        path.mkdir(parents=True, exist_ok=True)
        filled = any(path.iterdir())
        with suppress(OSError):  # others may have begun to write there meanwhile
            for place in missing:
                place.rmdir()
    except OSError as error:
        raise ScenarioError(f"{path}: {error.strerror}; give another folder with --out") from error
    return filled
