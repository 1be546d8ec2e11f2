"""The camera's calibration as OpenCV writes it; hilbed.vision.calibration reads it."""

from __future__ import annotations

import cv2

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
