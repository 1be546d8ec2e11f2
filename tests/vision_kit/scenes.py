"""Small scenarios for the tests of the kit, and what they leave behind."""

from __future__ import annotations

from pathlib import Path

from hilbed.scenario.load import Loaded, load
from hilbed.vision_kit.dataset import plan, write_dataset

SMALL = ("sensors.camera.width=160", "sensors.camera.height=32")


def small(*settings: str, frames: int = 4, seed: int | None = None) -> Loaded:
    """Returns vision/clean with a small camera."""
    return load("vision/clean", [*SMALL, f"vision.frames={frames}", *settings], seed)


def dataset(folder: Path, *settings: str, frames: int = 4, seed: int | None = None) -> Path:
    """Writes a small dataset."""
    write_dataset(plan(small(*settings, frames=frames, seed=seed)), folder, False, lambda _: None)
    return folder


def content(folder: Path) -> dict[str, bytes]:
    """Returns every file of a folder by its path in it."""
    files = (path for path in folder.rglob("*") if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}
