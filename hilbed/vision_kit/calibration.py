"""The camera's calibration as OpenCV writes and reads it."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np

from hilbed.types import ScenarioError
from hilbed.vision.lens import Lens


def calibration(lens: Lens) -> str:
    """Returns the text of a `cv2.FileStorage` in YAML: image size, camera matrix, distortion."""
    storage = cv2.FileStorage(".yaml", cv2.FileStorage_WRITE | cv2.FileStorage_MEMORY)
    storage.write("image_width", lens.width)
    storage.write("image_height", lens.height)
    storage.write("camera_matrix", lens.matrix)
    storage.write("distortion_coefficients", np.zeros((1, 5)))
    return str(storage.releaseAndGetString())


def read_calibration(path: Path, lens: Lens) -> Lens:
    """Returns the lens of a calibration; raises ScenarioError where it is none, or not that of `lens`."""
    try:
        text = path.read_text(encoding="utf-8")
        storage = cv2.FileStorage(text, cv2.FileStorage_READ | cv2.FileStorage_MEMORY)
        size = int(storage.getNode("image_width").real()), int(storage.getNode("image_height").real())
        matrix = storage.getNode("camera_matrix").mat()
    except (OSError, UnicodeDecodeError, cv2.error) as error:
        raise ScenarioError(f"{path}: cannot be read: {error}") from None
    if matrix is None or matrix.shape != (3, 3):
        raise ScenarioError(f"{path}: camera_matrix is missing, or not 3×3")
    if size != (lens.width, lens.height) or not np.allclose(matrix, lens.matrix, rtol=1e-9):
        raise ScenarioError(f"{path}: is not of the camera that the dataset's scenario.yaml describes")
    return lens
