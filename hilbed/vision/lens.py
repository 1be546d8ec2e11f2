"""The camera's intrinsics: which column of the image looks in which direction."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, degrees, pi, tan

from hilbed.types import Array, ScenarioError

SMALLEST, LARGEST = 16, 4096


@dataclass(frozen=True)
class Lens:
    """A pinhole without distortion and with square pixels, in OpenCV's convention.

    width, height: pixels, 16 to 4096; fov: horizontal field of view, rad, inside (0, π). Pixel (0, 0) is
    the centre of the upper left pixel, so the principal point is ((width − 1)/2, (height − 1)/2).
    Raises ScenarioError outside these limits.
    """

    width: int
    height: int
    fov: float

    def __post_init__(self) -> None:
        for name, size in (("width", self.width), ("height", self.height)):
            if not SMALLEST <= size <= LARGEST:
                raise ScenarioError(f"camera {name} is {size} pixels; it must lie in {SMALLEST}…{LARGEST}")
        if not 0.0 < self.fov < pi:
            raise ScenarioError(f"camera field of view is {degrees(self.fov):g}°; it must lie in (0°, 180°)")

    @property
    def focal(self) -> float:
        """Focal length in pixels: the outer edges of the outer pixels span the field of view."""
        return self.width / 2.0 / tan(self.fov / 2.0)

    @property
    def fx(self) -> float:
        return self.focal

    @property
    def fy(self) -> float:
        return self.focal

    @property
    def cx(self) -> float:
        return (self.width - 1) / 2.0

    @property
    def cy(self) -> float:
        return (self.height - 1) / 2.0

    @property
    def matrix(self) -> Array:
        """The (3, 3) camera matrix as OpenCV takes it."""
        import numpy as np

        return np.array([[self.focal, 0.0, self.cx], [0.0, self.focal, self.cy], [0.0, 0.0, 1.0]])

    def column(self, azimuth: float) -> float:
        """Returns the column (pixels) on the horizon that looks along `azimuth` (rad, left positive)."""
        return self.cx - self.focal * tan(azimuth)

    def azimuth(self, column: float) -> float:
        """Returns the azimuth (rad, left positive, camera's frame) along which `column` looks."""
        return atan((self.cx - column) / self.focal)
