"""Reads a dataset back, and says what is wrong with one that is not whole."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import astuple, replace
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from hilbed import yaml12
from hilbed.scenario.load import load
from hilbed.types import Image, ScenarioError
from hilbed.vision.calibration import read_lens
from hilbed.vision.image_file import read_image
from hilbed.vision.lens import Lens
from hilbed.vision.seams import Shot
from hilbed.vision_kit.dataset import CALIBRATION, DATASET, SCENARIO, TRUTH, read_truth
from hilbed.vision_kit.labelled import LabelledShot
from hilbed.vision_kit.studio import Subject


def is_dataset(name: str) -> bool:
    """Tells whether a name is that of a folder, and so not a scenario's."""
    return Path(name).is_dir()


class Archive:
    """The frames of a dataset folder; images are read one by one, when they are asked for.

    settings, seed, detector: as for a scenario, laid over the one that the dataset was made from. Raises
    ScenarioError naming the file where the folder is not a whole dataset.
    """

    def __init__(
        self, folder: Path, settings: Sequence[str] = (), seed: int | None = None, detector: str | None = None
    ) -> None:
        self.folder = folder
        self.about = _about(folder / DATASET)
        loaded = load(str(folder / SCENARIO), settings, seed, detector)
        self.subject = Subject(loaded._replace(name=str(self.about.get("scenario", folder.name))))
        self._lens = _lens(folder / CALIBRATION, self.subject.lens)
        self._count = int(self.about["frames"])
        _check_whole(folder, self._count)

    def __len__(self) -> int:
        return self._count

    @property
    def lens(self) -> Lens:
        return self._lens

    def shots(self, count: int | None = None) -> Iterator[LabelledShot]:
        """Yields the first frames, or all; raises ScenarioError for an image that cannot be used."""
        for file, truth in islice(read_truth(self.folder), count):
            image = _image(self._inside(file), self._lens)
            yield LabelledShot(Shot(image, truth.t, self._lens), truth)

    def _inside(self, file: str) -> Path:
        path = self.folder / file
        if not path.resolve().is_relative_to(self.folder.resolve()):
            raise ScenarioError(f"{self.folder / TRUTH}: {file} lies outside the dataset")
        return path


def _about(path: Path) -> dict[str, Any]:
    if not path.is_file():
        raise ScenarioError(
            f"{path.parent} is not a dataset: there is no {path.name}; hilbed frames writes one"
        )
    try:
        about, _ = yaml12.read(path.read_text(encoding="utf-8"), str(path))
        if not isinstance(about.get("frames"), int):
            raise ScenarioError(f"{path}: frames is missing, or no whole number")
    except (OSError, UnicodeDecodeError) as error:
        raise ScenarioError(f"{path}: cannot be read: {error}") from None
    return about


def _check_whole(folder: Path, count: int) -> None:
    path = folder / TRUTH
    try:
        with path.open("rb") as lines:
            found = sum(1 for _ in lines)
    except OSError as error:
        raise ScenarioError(f"{path}: {error.strerror}") from None
    if found != count:
        raise ScenarioError(
            f"{path}: {found} of {count} frames; the hilbed frames command that began {folder} goes on "
            "where it stopped"
        )


def _lens(path: Path, expected: Lens) -> Lens:
    """Returns the lens of the calibration, which has to be of the camera that the scenario describes."""
    lens = replace(read_lens(path), tilt=expected.tilt, roll=expected.roll)
    if not np.allclose(astuple(lens), astuple(expected), rtol=1e-9, atol=1e-12):
        raise ScenarioError(f"{path}: is not of the camera in {SCENARIO} beside it")
    return lens


def _image(path: Path, lens: Lens) -> Image:
    image = read_image(path)
    height, width, _ = image.shape
    if (width, height) != (lens.width, lens.height):
        size = f"{lens.width}×{lens.height}"
        raise ScenarioError(f"{path}: is {width}×{height}, but {CALIBRATION} is for {size} pixels")
    return image
