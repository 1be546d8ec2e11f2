"""Finds ArUco and AprilTag markers on beacons, and measures the azimuths of their middles."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from math import atan2, hypot
from typing import NamedTuple

import cv2
import numpy as np

from hilbed.scene import BeaconSpec
from hilbed.types import Array, Image
from hilbed.vision.detectors import MarkersSpec
from hilbed.vision.lens import Lens
from hilbed.vision.marker_fit import constant, fitted
from hilbed.vision.seams import Detection, Shot

_BESIDE = {"board": 0.0, "box": 0.35, "cylinder": 0.12}
"""Radii (rms, measured) that the middle of a marker that is seen alone lies beside the beacon's axis."""
_PAIR = 0.05
"""The same of the axis that two sides of a box tell."""


class Marker(NamedTuple):
    """A marker in an image: its number, and its corners (4, 2) in pixels, clockwise from the upper left."""

    number: int
    corners: Array


class MarkerDetector:
    """Finds the markers that the beacons carry; where none are known, any, whose number is the identity.

    The whole marker is fitted to a fraction of a pixel, and its diagonals meet in its middle, however it is
    seen. On a board that is the beacon's axis. Of a box that shows two sides, their widths tell where
    between their middles the axis is; a side that is seen alone, and a cylinder's marker, lies beside the
    axis, unknown how far, which is part of the stated standard deviation. Markers that no beacon carries are
    left out.
    """

    def __init__(
        self, spec: MarkersSpec, lens: Lens, beacons: Sequence[BeaconSpec] | None, anonymous: bool = False
    ) -> None:
        self._lens, self._std = lens, spec.std
        self._carriers: dict[tuple[str, int], list[int]] = defaultdict(list)
        for k, beacon in enumerate(beacons or ()):
            if beacon.marker is not None:
                self._carriers[beacon.dictionary, beacon.marker].append(k)
        self._beacons, self._anonymous = beacons, anonymous
        families = {spec.dictionary} if beacons is None else {name for name, _ in self._carriers}
        self._finders = {name: finder(name) for name in sorted(families)}

    def detect(self, shot: Shot) -> list[Detection]:
        """Returns what is seen, from left to right."""
        grey = np.asarray(cv2.cvtColor(shot.image, cv2.COLOR_RGB2GRAY), np.uint8)
        found = [
            detection
            for family, one in self._finders.items()
            for markers in alike(self._fitted(family, grey, find(one, grey)))
            for detection in self._detections(family, markers)
        ]
        return sorted(found, key=lambda detection: detection.column)

    def _fitted(self, family: str, grey: Image, markers: Sequence[Marker]) -> list[Marker]:
        """Returns those markers that are looked for, as they fit the image best."""
        wanted = [one for one in markers if self._beacons is None or (family, one.number) in self._carriers]
        return [one._replace(corners=fitted(grey, family, *one)) for one in wanted]

    def _detections(self, family: str, alike: Sequence[Marker]) -> list[Detection]:
        """Returns what markers of one number show."""
        if self._beacons is None:
            return [self._detection(one, one.number, 0.0) for one in alike]
        carriers = self._carriers[family, alike[0].number]
        beacon = self._beacons[carriers[0]]
        if len(carriers) == 1 and len(alike) == 2 and beacon.shape == "box":
            return [self._between(alike, carriers[0], _PAIR * self._radius(beacon, alike[0]))]
        identity, radii = (carriers[0] if len(carriers) == 1 else None), _BESIDE[beacon.shape]
        return [self._detection(one, identity, radii * self._radius(beacon, one)) for one in alike]

    def _detection(self, marker: Marker, beacon: int | None, beside: float) -> Detection:
        column, row = middle(self._lens, marker.corners)
        azimuth, _ = self._lens.direction(column, row)
        std = hypot(self._pixel(column, row) * self._std, beside)
        return Detection(float(azimuth), std, column, None if self._anonymous else beacon, row)

    def _between(self, sides: Sequence[Marker], beacon: int, beside: float) -> Detection:
        """Returns where the axis of a box is that shows two sides.

        A side's middle is as far beside the axis as the other side is wide, both for the same reason; heights
        tell how much nearer one is than the other.
        """
        one, other = sides
        first, second = (self._detection(side, beacon, beside) for side in sides)
        nearer = (height(one) / height(other)) ** 2
        share = width(other) * nearer / (width(one) + width(other) * nearer)
        return first._replace(
            azimuth=(1.0 - share) * first.azimuth + share * second.azimuth,
            column=(1.0 - share) * first.column + share * second.column,
            row=(1.0 - share) * first.row + share * second.row,
        )

    def _pixel(self, column: float, row: float) -> float:
        """Returns how far (rad) a column is from the next."""
        azimuth, _ = self._lens.direction(np.array([column - 0.5, column + 0.5]), np.array([row, row]))
        return float(abs(azimuth[1] - azimuth[0]))

    def _radius(self, beacon: BeaconSpec, marker: Marker) -> float:
        """Returns how large (rad) half the width of a beacon is seen, from the height of its marker."""
        cells = cv2.aruco.getPredefinedDictionary(constant(beacon.dictionary)).markerSize
        black = 2.0 * beacon.foot_radius * (cells + 2) / (cells + 4)  # the margin is white
        return atan2(beacon.foot_radius, black * self._lens.fy / height(marker))


def finder(family: str) -> cv2.aruco.ArucoDetector:
    """Returns OpenCV's detector of a dictionary, with corners refined to a fraction of a pixel."""
    parameters = cv2.aruco.DetectorParameters()
    parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
    return cv2.aruco.ArucoDetector(cv2.aruco.getPredefinedDictionary(constant(family)), parameters)


def find(one: cv2.aruco.ArucoDetector, grey: Image) -> list[Marker]:
    """Returns the markers in an (H, W) image."""
    corners, numbers, _ = one.detectMarkers(grey)
    if numbers is None:
        return []
    return [
        Marker(int(number), np.asarray(four, np.float64).reshape(4, 2))
        for number, four in zip(np.ravel(numbers), corners, strict=True)
    ]


def alike(markers: Sequence[Marker]) -> list[list[Marker]]:
    """Returns the markers by their number, the numbers in the order of their first appearance."""
    groups: dict[int, list[Marker]] = defaultdict(list)
    for marker in markers:
        groups[marker.number].append(marker)
    return list(groups.values())


def width(marker: Marker) -> float:
    """Returns the mean width of a marker in pixels."""
    upper_left, upper_right, lower_right, lower_left = marker.corners
    return float(np.linalg.norm(upper_right - upper_left) + np.linalg.norm(lower_right - lower_left)) / 2.0


def height(marker: Marker) -> float:
    """Returns the mean height of a marker in pixels."""
    upper_left, upper_right, lower_right, lower_left = marker.corners
    return float(np.linalg.norm(lower_left - upper_left) + np.linalg.norm(lower_right - upper_right)) / 2.0


def middle(lens: Lens, corners: Array) -> tuple[float, float]:
    """Returns column and row where the diagonals of a marker meet, distortion taken into account."""
    flat = cv2.undistortPoints(corners.reshape(-1, 1, 2), lens.matrix, lens.distortion).reshape(4, 2)
    a, b, c, d = flat
    along, _ = np.linalg.solve(np.column_stack((c - a, b - d)), b - a)
    ray = np.array([[*(a + along * (c - a)), 1.0]])
    pixel, _ = cv2.projectPoints(ray, np.zeros(3), np.zeros(3), lens.matrix, lens.distortion)
    column, row = pixel.ravel().tolist()
    return column, row
