"""A video file as a camera, frame by frame at its own times."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import cv2

from hilbed.clock import MILLISECOND
from hilbed.types import Image, ScenarioError
from hilbed.vision.calibration import Optics
from hilbed.vision.image_file import rgb
from hilbed.vision.lens import Lens
from hilbed.vision.seams import Shot


class VideoFile:
    """The frames of a video, in whatever form OpenCV reads it.

    It ends with the last frame that can be read: of one that is cut off, that is what is left. Raises
    ScenarioError where there is none, or the calibration does not fit.
    """

    def __init__(self, path: Path, optics: Optics) -> None:
        self.name = str(path)
        if not path.is_file():
            raise ScenarioError(f"there is no file {path}")
        be_quiet()
        self._capture = cv2.VideoCapture(str(path), cv2.CAP_FFMPEG)
        first = self._read()
        if first is None:
            self.close()
            raise ScenarioError(f"{path}: is no video that can be read, or is cut off before its first frame")
        height, width, _ = first.shape
        try:
            self.lens: Lens = optics.lens(width, height, self.name)
        except ScenarioError:
            self.close()
            raise
        self._first: Image | None = first

    def frames(self) -> Iterator[Shot]:
        """Yields the frames, once."""
        image, self._first = self._first, None
        while image is not None:
            t = round(self._capture.get(cv2.CAP_PROP_POS_MSEC) * MILLISECOND)
            yield Shot(image, t, self.lens)
            image = self._read()

    def close(self) -> None:
        """Closes the file."""
        self._capture.release()

    def _read(self) -> Image | None:
        there, image = self._capture.read()
        return rgb(image, self.name) if there else None


def be_quiet() -> None:
    """Keeps OpenCV and FFmpeg from writing on standard error what is told by a message anyway."""
    os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "-8")
    cv2.utils.logging.setLogLevel(cv2.utils.logging.LOG_LEVEL_SILENT)
