"""The camera's intrinsics and how it is tilted: which direction a pixel looks in, and back."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import atan, degrees, hypot, isfinite, pi, tan
from typing import TYPE_CHECKING, Self

from hilbed.types import Array, ScenarioError

if TYPE_CHECKING:
    from hilbed.vision.distortion import Coefficients

SMALLEST, LARGEST = 16, 4096
STEEPEST = 1.4
"""rad, the most that a camera may be tilted."""
_BORDER = 33  # points a side of the image that are tried for folds
_WIDEST = 10.0  # focal lengths from the middle, 84°: what a pinhole can still be rendered for


@dataclass(frozen=True)
class Lens:
    """A camera as OpenCV calibrates it, tilted and rolled on its pan axis.

    width, height: pixels, 16 to 4096; fx, fy, cx, cy: focal lengths and principal point in pixels, where
    pixel (0, 0) is the centre of the upper left pixel; k1, k2, p1, p2, k3: distortion; tilt (down positive)
    and roll: rad. Directions are azimuth (left positive) and elevation (up positive) about the upright pan
    axis, from where an untilted camera's middle looks. Raises ScenarioError for one that cannot be, or whose
    distortion shows a direction twice.
    """

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    k1: float = 0.0
    k2: float = 0.0
    p1: float = 0.0
    p2: float = 0.0
    k3: float = 0.0
    tilt: float = 0.0
    roll: float = 0.0

    @classmethod
    def of_fov(cls, width: int, height: int, fov: float) -> Self:
        """Returns a pinhole with square pixels.

        fov: rad inside (0, π), between the outer edges of the outer columns.
        """
        if not 0.0 < fov < pi:
            raise ScenarioError(f"camera field of view is {degrees(fov):g}°; it must lie in (0°, 180°)")
        focal = width / 2.0 / tan(fov / 2.0)
        return cls(width, height, focal, focal, (width - 1) / 2.0, (height - 1) / 2.0)

    def __post_init__(self) -> None:
        for name, size in (("width", self.width), ("height", self.height)):
            if not SMALLEST <= size <= LARGEST:
                raise ScenarioError(f"camera {name} is {size} pixels; it must lie in {SMALLEST}…{LARGEST}")
        for name, value in vars(self).items():
            if not isfinite(value):
                raise ScenarioError(f"camera {name} is {value}; it must be finite")
        for name, focal in (("fx", self.fx), ("fy", self.fy)):
            if focal <= 0.0:
                raise ScenarioError(f"camera {name} is {focal:g} pixels; it must be above 0")
        if abs(self.tilt) > STEEPEST:
            told = f"camera tilt is {degrees(self.tilt):.4g}°; it must lie within ±{degrees(STEEPEST):.3g}°"
            raise ScenarioError(told)
        if self.distorted:
            self._check_folds()

    @cached_property
    def coefficients(self) -> Coefficients:
        from hilbed.vision.distortion import Coefficients

        return Coefficients(self.k1, self.k2, self.p1, self.p2, self.k3)

    @cached_property
    def distorted(self) -> bool:
        return any((self.k1, self.k2, self.p1, self.p2, self.k3))

    @cached_property
    def upright(self) -> bool:
        """Whether it is neither tilted nor rolled."""
        return not (self.tilt or self.roll)

    @cached_property
    def plain(self) -> bool:
        """Whether it is upright and does not distort: an azimuth is a matter of the column alone."""
        return self.upright and not self.distorted

    @property
    def matrix(self) -> Array:
        """The (3, 3) camera matrix as OpenCV takes it."""
        import numpy as np

        return np.array([[self.fx, 0.0, self.cx], [0.0, self.fy, self.cy], [0.0, 0.0, 1.0]])

    @property
    def distortion(self) -> Array:
        """The (5,) distortion coefficients as OpenCV takes them."""
        import numpy as np

        return np.array([self.k1, self.k2, self.p1, self.p2, self.k3])

    @property
    def fov(self) -> float:
        """What the principal row spans between the outer edges of the outer columns, rad."""
        return self.azimuth(-0.5) - self.azimuth(self.width - 0.5)

    @cached_property
    def span(self) -> tuple[float, float]:
        """The least and the greatest azimuth (rad) that any point of the image looks along."""
        import numpy as np

        column, row = self._border()
        azimuth = self.direction(column, row)[0]
        return float(np.min(azimuth)), float(np.max(azimuth))

    def column(self, azimuth: float) -> float:
        """Returns the column (pixels) that looks along `azimuth` (rad) on the horizon; NaN out of sight."""
        if self.plain:
            return self.cx - self.fx * tan(azimuth)
        return float(self.pixel(azimuth, 0.0)[0])

    def azimuth(self, column: float) -> float:
        """Returns the azimuth (rad) along which `column` of the principal row looks."""
        if self.plain:
            return atan((self.cx - column) / self.fx)
        return float(self.direction(column, self.cy)[0])

    def direction(self, column: float | Array, row: float | Array) -> tuple[Array, Array]:
        """Returns azimuth and elevation (rad) along which points of the image look, arrays or numbers."""
        from hilbed.vision.sightline import direction

        return direction(self, column, row)

    def pixel(self, azimuth: float | Array, elevation: float | Array) -> tuple[Array, Array]:
        """Returns column and row (pixels) that look in a direction (rad), arrays or numbers.

        NaN for what lies behind the camera or beyond where its distortion is defined.
        """
        from hilbed.vision.sightline import pixel

        return pixel(self, azimuth, elevation)

    def _border(self) -> tuple[Array, Array]:
        """Returns columns and rows of points along the outer edges of the outer pixels."""
        import numpy as np

        across = np.linspace(-0.5, self.width - 0.5, _BORDER)
        down = np.linspace(-0.5, self.height - 0.5, _BORDER)
        left, top = np.full(_BORDER, -0.5), np.full(_BORDER, -0.5)
        column = np.concatenate((across, across, left, left + self.width))
        return column, np.concatenate((top, top + self.height, down, down))

    def _check_folds(self) -> None:
        from hilbed.vision.distortion import folds_at, undistort

        column, row = self._border()
        x, y = (column - self.cx) / self.fx, (row - self.cy) / self.fy
        given = (f"{name} {value:g}" for name, value in self.coefficients._asdict().items() if value)
        told = f"camera distortion ({', '.join(given)})"
        fold = folds_at(x, y, self.coefficients)
        if fold is not None:
            at = f"column {column[fold]:g}, row {row[fold]:g}"
            raise ScenarioError(f"{told} folds the image between its middle and {at}; it must not")
        u, v = undistort(x, y, self.coefficients)
        if max(map(hypot, u.tolist(), v.tolist())) > _WIDEST:
            raise ScenarioError(
                f"{told} shows what is more than {degrees(atan(_WIDEST)):.0f}° off the middle"
            )
