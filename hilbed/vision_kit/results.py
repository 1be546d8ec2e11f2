"""The folder that `hilbed vision` leaves behind: numbers as JSON and a page."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from hilbed.record.disk import RecordError
from hilbed.record.folder import check_folder, write_whole
from hilbed.types import ScenarioError


def admit(folder: Path, numbers: str, force: bool) -> None:
    """Raises ScenarioError where a folder cannot be written, or holds what must not be overwritten.

    numbers: name of its JSON.
    """
    if not check_folder(folder):
        return
    if not (folder / numbers).is_file():
        raise ScenarioError(f"{folder} holds something else; give another folder with --out")
    if not force:
        raise ScenarioError(f"{folder} exists; --force replaces what is in it, --out takes another folder")


def keep(folder: Path, numbers: str, content: Mapping[str, Any], page: str, text: str) -> None:
    """Writes JSON and page; raises RecordError if that cannot be."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise RecordError(f"{folder}: {error.strerror}") from error
    write_whole(folder / numbers, (json.dumps(content, indent=2, allow_nan=False) + "\n").encode())
    write_whole(folder / page, text.encode())
