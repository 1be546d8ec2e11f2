"""A folder of images as a camera: PNG and JPEG in the order of their names, with the stamps that it has."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from math import isfinite
from pathlib import Path

from hilbed.clock import SECOND
from hilbed.types import Image, Nanos, ScenarioError
from hilbed.vision.calibration import Optics
from hilbed.vision.image_file import SUFFIXES, read_image
from hilbed.vision.lens import Lens
from hilbed.vision.seams import Shot

STAMPS = ("frames.jsonl", "stamps.txt")
"""Who knows the times: of a run's frames, JSON lines with t (s) and file; of others, lines `seconds file`."""


Reader = Callable[[str], tuple[float, str]]


class ImageFolder:
    """The images of a folder.

    Frame k is of k / rate (Hz), or of the time that frames.jsonl or stamps.txt says. Images are read when
    they are asked for. Raises ScenarioError, naming the file, for what cannot be read, or does not have the
    size that the calibration or the first image has.
    """

    def __init__(self, folder: Path, optics: Optics, rate: float = 30.0) -> None:
        self.name = str(folder)
        self._folder = folder
        self._files = sorted(path for path in folder.iterdir() if path.suffix.lower() in SUFFIXES)
        if not self._files:
            raise ScenarioError(f"{folder}: there is no image in it ({', '.join(SUFFIXES)})")
        height, width, _ = read_image(self._files[0]).shape
        self.lens: Lens = optics.lens(width, height, str(self._files[0]))
        self._stamps = _stamps(folder)
        self._period = SECOND / rate

    def __len__(self) -> int:
        return len(self._files)

    def frames(self) -> Iterator[Shot]:
        """Yields the images in the order of their names."""
        for k, path in enumerate(self._files):
            yield Shot(self._read(path), self._time(k, path), self.lens)

    def close(self) -> None:
        """Holds nothing."""

    def _read(self, path: Path) -> Image:
        image = read_image(path)
        height, width, _ = image.shape
        if (width, height) != (self.lens.width, self.lens.height):
            told = f"but the images before, or the calibration, {self.lens.width}×{self.lens.height}"
            raise ScenarioError(f"{path}: has {width}×{height} pixels, {told}")
        return image

    def _time(self, k: int, path: Path) -> Nanos:
        if not self._stamps:
            return round(k * self._period)
        if path.name not in self._stamps:
            raise ScenarioError(f"{path}: has no stamp, but other images of its folder have")
        return self._stamps[path.name]


def _stamps(folder: Path) -> Mapping[str, Nanos]:
    """Returns the time of each file, by its name; empty where the folder has no stamps."""
    for name, reader in zip(STAMPS, (_json_line, _text_line), strict=True):
        path = folder / name
        if path.is_file():
            lines = enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), 1)
            return dict(_stamp(reader, line, f"{path}:{number}") for number, line in lines if _says(line))
    return {}


def _says(line: str) -> bool:
    return bool(line.strip()) and not line.startswith("#")


def _stamp(reader: Reader, line: str, place: str) -> tuple[str, Nanos]:
    try:
        seconds, file = reader(line)
        if not isfinite(seconds):
            raise ValueError
    except (ValueError, KeyError, TypeError):
        raise ScenarioError(f"{place}: does not say a time in s and a file") from None
    return file, round(seconds * SECOND)


def _json_line(line: str) -> tuple[float, str]:
    entry = json.loads(line)
    return float(entry["t"]), str(entry["file"])


def _text_line(line: str) -> tuple[float, str]:
    seconds, file = line.split(maxsplit=1)
    return float(seconds), file.strip()
