"""Where beacons really are, seen from the camera: for the witness, never for a detector."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, hypot, remainder, tau
from typing import NamedTuple

from hilbed.angles import wrap
from hilbed.scene import BeaconSpec
from hilbed.types import Image
from hilbed.vision.lens import Lens
from hilbed.vision.seams import BeaconTruth, Viewpoint

SPURIOUS = -1
_IN_LINE = 1e-5  # rad


class Sight(NamedTuple):
    """A beacon from the optical centre: azimuth of its axis (rad), distance (m), half its width (rad)."""

    azimuth: float
    distance: float
    half_width: float


def sights(beacons: Sequence[BeaconSpec], x: float, y: float, yaw: float) -> list[Sight]:
    """Returns where each beacon is seen from an optical centre at x, y (m, map), relative to yaw (rad)."""
    seen = []
    for beacon in beacons:
        bx, by = beacon.at
        dx, dy = bx - x, by - y
        distance = hypot(dx, dy)
        seen.append(Sight(wrap(atan2(dy, dx) - yaw), distance, atan2(beacon.foot_radius, distance)))
    return seen


def match(azimuth: float, seen: Sequence[Sight]) -> int:
    """Returns the index of the beacon at which a noiseless azimuth (rad) points, SPURIOUS for none.

    Azimuth and sights are in one frame. It is judged by geometry alone, so that a detector's wrong identity
    shows. Of two in line it is the nearer one, which hides the other.
    """
    offsets = [abs(remainder(azimuth - sight.azimuth, tau)) for sight in seen]
    hit = [k for k, sight in enumerate(seen) if offsets[k] <= sight.half_width]
    if len(hit) == 1:
        return hit[0]
    return min(hit, key=lambda k: (round(offsets[k] / _IN_LINE), seen[k].distance), default=SPURIOUS)


def beacons_truth(
    beacons: Sequence[BeaconSpec], view: Viewpoint, pan: float, lens: Lens, labels: Image
) -> tuple[BeaconTruth, ...]:
    """Returns the truth of each beacon.

    view: the camera, its pitch and roll those of the lens; pan: rad, robot's frame; labels: (H, W), as the
    renderer tells them from there.
    """
    from hilbed.vision.outline import middle_height, pixels

    found = []
    for k, (beacon, sight) in enumerate(zip(beacons, sights(beacons, view.x, view.y, view.yaw), strict=True)):
        elevation = atan2(middle_height(beacon) - view.z, sight.distance)
        column, row = lens.pixel(sight.azimuth, elevation)
        box, shown = _box(labels, k + 1)
        visible = min(1.0, shown / max(1, pixels(beacon, view, lens))) if shown else 0.0
        found.append(
            BeaconTruth(
                k, sight.azimuth, elevation, wrap(sight.azimuth + pan), elevation, sight.distance,
                visible, box, float(column), float(row),
            )
        )  # fmt: skip
    return tuple(found)


def _box(labels: Image, label: int) -> tuple[tuple[int, int, int, int] | None, int]:
    """Returns the outermost columns and rows of a label's pixels (left, top, right, bottom), their number."""
    rows, columns = (labels == label).nonzero()
    if not rows.size:
        return None, 0
    return (int(columns.min()), int(rows.min()), int(columns.max()), int(rows.max())), int(rows.size)
