"""The camera's calibration as OpenCV writes and reads it."""

from __future__ import annotations

import cv2

from hilbed.vision.lens import Lens


def calibration(lens: Lens) -> str:
    """Returns the text of a `cv2.FileStorage` in YAML: image size, camera matrix, distortion."""
    import numpy as np

    storage = cv2.FileStorage(".yaml", cv2.FileStorage_WRITE | cv2.FileStorage_MEMORY)
    storage.write("image_width", lens.width)
    storage.write("image_height", lens.height)
    storage.write("camera_matrix", lens.matrix)
    storage.write("distortion_coefficients", np.zeros((1, 5)))
    return str(storage.releaseAndGetString())
