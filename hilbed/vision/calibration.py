"""A camera's calibration as OpenCV writes it: which lens took the images."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import cv2

from hilbed.types import ScenarioError
from hilbed.vision.lens import Lens

COEFFICIENTS = ("k1", "k2", "p1", "p2", "k3")


class Optics(NamedTuple):
    """What is known of a camera before its first image: its calibration, else its field of view (rad)."""

    calibration: Lens | None
    fov: float

    def lens(self, width: int, height: int, name: str) -> Lens:
        """Returns the lens of images of so many pixels; name: of what has them.

        Raises ScenarioError where the calibration is of others.
        """
        known = self.calibration
        if known is None:
            return Lens.of_fov(width, height, self.fov)
        if (known.width, known.height) != (width, height):
            told = f"{known.width}×{known.height} pixels, but {name} has {width}×{height}"
            raise ScenarioError(f"the calibration does not fit: it is of images of {told}")
        return known


def read_lens(path: Path) -> Lens:
    """Returns the lens of a `cv2.FileStorage`.

    Its names are image_width, image_height, camera_matrix and distortion_coefficients, those of OpenCV.
    Raises ScenarioError naming the file where it is no calibration, or one with more than k1 k2 p1 p2 k3.
    """
    storage = _opened(path)
    size = [_number(storage, name, path) for name in ("image_width", "image_height")]
    camera = _matrix(storage, "camera_matrix", path)
    distortion = _matrix(storage, "distortion_coefficients", path).ravel().tolist()
    if camera.shape != (3, 3):
        raise ScenarioError(f"{path}: camera_matrix is {camera.shape[0]}×{camera.shape[1]}, not 3×3")
    if len(distortion) > len(COEFFICIENTS) and any(distortion[len(COEFFICIENTS) :]):
        raise ScenarioError(
            f"{path}: has {len(distortion)} distortion coefficients; {', '.join(COEFFICIENTS)} are used"
        )
    if camera[0, 1]:
        raise ScenarioError(f"{path}: camera_matrix has a skew of {camera[0, 1]:g}; it must be 0")
    (fx, _, cx), (_, fy, cy), _ = camera.tolist()
    try:
        return Lens(int(size[0]), int(size[1]), fx, fy, cx, cy, *distortion[: len(COEFFICIENTS)])
    except ScenarioError as error:
        raise ScenarioError(f"{path}: {error}") from None


def _opened(path: Path) -> Any:
    try:
        storage = cv2.FileStorage(
            path.read_text(encoding="utf-8"), cv2.FileStorage_READ | cv2.FileStorage_MEMORY
        )
        opened = storage.isOpened()
    except OSError as error:
        raise ScenarioError(f"{path}: {error.strerror}") from None
    except (UnicodeDecodeError, cv2.error, SystemError):
        opened = False
    if not opened:
        raise ScenarioError(f"{path}: is no calibration that OpenCV can read (cv2.FileStorage, YAML)")
    return storage


def _number(storage: Any, name: str, path: Path) -> float:
    node = storage.getNode(name)
    if node.empty() or not (node.isInt() or node.isReal()):
        raise ScenarioError(f"{path}: {name} is missing, or no number")
    return float(node.real())


def _matrix(storage: Any, name: str, path: Path) -> Any:
    try:
        matrix = storage.getNode(name).mat()
    except (cv2.error, SystemError):
        matrix = None
    if matrix is None or matrix.ndim != 2:
        raise ScenarioError(f"{path}: {name} is missing, or no matrix")
    return matrix
