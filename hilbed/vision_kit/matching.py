"""Which detection shows which beacon: by geometry alone, so that wrong identities show."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite, nan
from typing import NamedTuple

from hilbed.angles import wrap
from hilbed.vision.lens import Lens
from hilbed.vision.seams import BeaconTruth, Detection

REACH = 3.0
"""Pixels by which a detection may lie outside of the beacon that it shows."""


STEP = 1e-6  # rad


class Sighting(NamedTuple):
    """A beacon of which a frame shows something, and what was found of it.

    frame: number; light: mean brightness of the frame, 0…1; cut: whether a side is cut off by the border of
    the image or by a nearer beacon; azimuth: the true one (rad); error: of the azimuth, rad, and in pixels
    (left positive); std: rad, as stated; all NaN where it was not found; named: the identity that the
    detection states.
    """

    frame: int
    light: float
    beacon: int
    distance: float
    visible: float
    azimuth: float
    cut: bool
    found: bool = False
    error: float = nan
    error_px: float = nan
    std: float = nan
    named: int | None = None

    @property
    def mistaken(self) -> bool:
        """Whether it was taken for another beacon."""
        return self.named is not None and self.named != self.beacon


class Stray(NamedTuple):
    """A detection that shows no beacon; distance, visible: of the one nearest to it (NaN: none in sight).

    detection: its number in the frame.
    """

    frame: int
    light: float
    detection: int
    distance: float
    visible: float


class Matched(NamedTuple):
    """One frame: the beacons it shows and the detections that show none of them."""

    sightings: list[Sighting]
    strays: list[Stray]


def match(
    frame: tuple[int, float], beacons: Sequence[BeaconTruth], found: Sequence[Detection], lens: Lens
) -> Matched:
    """Pairs each detection with at most one beacon, nearest pairs first; frame: number and light."""
    seen = [beacon for beacon in beacons if beacon.box is not None]
    offsets = {
        (d, b): pixels(lens, beacon, wrap(detection.azimuth - beacon.azimuth))
        for d, detection in enumerate(found)
        for b, beacon in enumerate(seen)
    }
    pairs = _pairs(offsets, [_gate(beacon) for beacon in seen])
    sightings = []
    for b, beacon in enumerate(seen):
        blank = Sighting(
            *frame, beacon.beacon, beacon.distance, beacon.visible, beacon.azimuth, _cut(beacon, seen, lens)
        )
        sightings.append(_with(blank, beacon, found[pairs[b]], lens) if b in pairs else blank)
    left = sorted(set(range(len(found))) - set(pairs.values()))
    return Matched(sightings, [_stray(frame, d, seen, offsets) for d in left])


def _cut(beacon: BeaconTruth, seen: Sequence[BeaconTruth], lens: Lens) -> bool:
    """Tells whether a side is out of the image, or in columns in which a nearer beacon may hide it."""
    left, right = _columns(beacon)
    nearer = (_columns(one) for one in seen if one.distance < beacon.distance)
    hidden = any(first <= right + 1 and last >= left - 1 for first, last in nearer)
    return left <= 0 or right >= lens.width - 1 or hidden


def _columns(beacon: BeaconTruth) -> tuple[int, int]:
    """Returns the outermost columns that show a beacon."""
    assert beacon.box is not None, "only what is seen is matched"
    return beacon.box[0], beacon.box[2]


def pixels(lens: Lens, beacon: BeaconTruth, error: float) -> float:
    """Returns how many columns an azimuth's error (rad) is at its beacon, both left positive."""
    right, _ = lens.pixel(beacon.azimuth - STEP, beacon.elevation)
    left, _ = lens.pixel(beacon.azimuth + STEP, beacon.elevation)
    return error * float(right - left) / (2 * STEP)


def _gate(beacon: BeaconTruth) -> float:
    left, right = _columns(beacon)
    return 0.5 * (right - left + 1) + REACH


def _pairs(offsets: dict[tuple[int, int], float], gates: Sequence[float]) -> dict[int, int]:
    """Returns the detection of each beacon that has one."""
    pairs: dict[int, int] = {}
    for (d, b), offset in sorted(offsets.items(), key=lambda item: abs(item[1])):
        if isfinite(offset) and abs(offset) <= gates[b] and b not in pairs and d not in pairs.values():
            pairs[b] = d
    return pairs


def _with(blank: Sighting, beacon: BeaconTruth, detection: Detection, lens: Lens) -> Sighting:
    error = wrap(detection.azimuth - beacon.azimuth)
    return blank._replace(
        found=True,
        error=error,
        error_px=pixels(lens, beacon, error),
        std=detection.std,
        named=detection.beacon,
    )


def _stray(
    frame: tuple[int, float], d: int, seen: Sequence[BeaconTruth], offsets: dict[tuple[int, int], float]
) -> Stray:
    nearest = min(range(len(seen)), key=lambda b: abs(offsets[d, b]), default=None)
    if nearest is None:
        return Stray(*frame, d, nan, nan)
    return Stray(*frame, d, seen[nearest].distance, seen[nearest].visible)
