"""The camera's calibration as OpenCV writes and reads it."""

from __future__ import annotations

from dataclasses import astuple
from pathlib import Path

import cv2
import numpy as np

from hilbed.types import Array, ScenarioError
from hilbed.vision.lens import Lens


def calibration(lens: Lens) -> str:
    """Returns the text of a `cv2.FileStorage` in YAML.

    image_width, image_height, camera_matrix, distortion_coefficients (k1 k2 p1 p2 k3) as OpenCV's own
    programs name them; tilt (down positive) and roll, rad, on the pan axis.
    """
    storage = cv2.FileStorage(".yaml", cv2.FileStorage_WRITE | cv2.FileStorage_MEMORY)
    storage.write("image_width", lens.width)
    storage.write("image_height", lens.height)
    storage.write("camera_matrix", lens.matrix)
    storage.write("distortion_coefficients", lens.distortion.reshape(1, 5))
    storage.write("tilt", lens.tilt)
    storage.write("roll", lens.roll)
    return str(storage.releaseAndGetString())


def read_calibration(path: Path) -> Lens:
    """Returns the lens of a calibration; raises ScenarioError where it is none, or of no possible camera."""
    try:
        text = path.read_text(encoding="utf-8")
        storage = cv2.FileStorage(text, cv2.FileStorage_READ | cv2.FileStorage_MEMORY)
        return _lens(storage)
    except OSError as error:
        raise ScenarioError(f"{path}: {error.strerror}") from None
    except (UnicodeDecodeError, cv2.error, ValueError, ScenarioError) as error:
        raise ScenarioError(f"{path}: is no calibration that can be used: {error}") from None


def _lens(storage: cv2.FileStorage) -> Lens:
    width, height = (int(_number(storage, name)) for name in ("image_width", "image_height"))
    matrix = _matrix(storage, "camera_matrix", 9).reshape(3, 3)
    k1, k2, p1, p2, k3 = _matrix(storage, "distortion_coefficients", 5).tolist()
    (fx, skew, cx), (_, fy, cy) = matrix[:2].tolist()
    if skew:
        raise ValueError(f"camera_matrix has a skew of {skew:g}, a Lens has none")
    tilt, roll = (_number(storage, name) for name in ("tilt", "roll"))
    return Lens(width, height, fx, fy, cx, cy, k1, k2, p1, p2, k3, tilt, roll)


def _number(storage: cv2.FileStorage, name: str) -> float:
    node = storage.getNode(name)
    if node.empty() or not (node.isInt() or node.isReal()):
        raise ValueError(f"{name} is missing, or no number")
    return float(node.real())


def _matrix(storage: cv2.FileStorage, name: str, size: int) -> Array:
    matrix = storage.getNode(name).mat()
    if matrix is None or matrix.size != size:
        raise ValueError(f"{name} is missing, or has not {size} numbers")
    return np.asarray(matrix, float).ravel()


def same(a: Lens, b: Lens) -> bool:
    """Tells whether two lenses are one, but for how many digits a file holds."""
    return bool(np.allclose(astuple(a), astuple(b), rtol=1e-9, atol=1e-12))
