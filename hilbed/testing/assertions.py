"""One assertion on what a detector found in a frame, with a message that says what is wrong."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Sequence
from math import degrees, inf
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # a plugin is imported by every run of pytest
    from hilbed.vision.seams import Detection
    from hilbed.vision_kit.labelled import LabelledShot
    from hilbed.vision_kit.matching import Matched, Sighting

FAILURES = Path("hilbed-failures")
"""Where frames of failed assertions are kept, in the current folder."""


def assert_azimuths(
    detections: Sequence[object],
    truth: LabelledShot,
    within: float,
    visible: float = 0.25,
    distance: tuple[float, float] = (0.0, inf),
) -> None:
    """Asserts that every beacon that is due is found, within `within` (rad), as itself, and nothing else is.

    detections: Detection, or tuples or dicts of its fields; truth: the frame that they are of. Due is a
    beacon of which at least the part `visible` (0…1) is seen, at a distance (m, from and to), and no side is
    cut off by the border of the image. A beacon that is not due may be found, but not wrongly.
    On failure the frame is kept as PNG, as it is and with everything drawn into it.
    """
    __tracebackhide__ = True
    from hilbed.vision.returned import checked, plain
    from hilbed.vision_kit.matching import match
    from hilbed.vision_kit.trial import Rules

    lens, beacons = truth.shot.lens, truth.truth.beacons
    found = checked(plain(detections), lens, len(beacons))
    matched = match((0, 0.0), beacons, found, lens)
    rules = Rules(visible, distance)
    wrong = [line for one in matched.sightings if (line := _wrong(one, within, rules.due(one)))]
    wrong += _strays(found, matched)
    if wrong:
        kept = _keep(truth, found)
        due = sum(rules.due(one) for one in matched.sightings)
        head = f"{len(wrong)} wrong in a frame with {due} beacons due and {len(found)} detections"
        raise AssertionError("\n".join([head, *(f"  {line}" for line in wrong), f"  frame: {kept}"]))


def _wrong(one: Sighting, within: float, due: bool) -> str:
    """Returns what is wrong with what was found of a beacon; nothing where all is well."""
    part = "" if one.visible > 0.995 else f", {100 * one.visible:.0f} % visible"
    place = f"beacon {one.beacon} at {degrees(one.azimuth):+.3f}°, {one.distance:.2f} m{part}"
    if not one.found:
        return f"{place}: missed" if due else ""
    if one.mistaken:
        return f"{place}: taken for beacon {one.named}"
    if abs(one.error) > within:
        off = f"{1000 * degrees(one.error):+.3g} mdeg ({one.error_px:+.2g} px)"
        return f"{place}: off by {off}, allowed are {1000 * degrees(within):.3g} mdeg"
    return ""


def _strays(found: Sequence[Detection], matched: Matched) -> Iterator[str]:
    for one in matched.strays:
        detection = found[one.detection]
        name = "" if detection.beacon is None else f" taken for beacon {detection.beacon}"
        place = f"detection at {degrees(detection.azimuth):+.3f}°, column {detection.column:.1f}"
        yield f"{place}{name}: no beacon there"


def _keep(truth: LabelledShot, found: Sequence[Detection]) -> Path:
    """Writes the frame, and beside it one with everything drawn into it; returns the first one's path."""
    from hilbed.vision_kit.dataset import png
    from hilbed.vision_kit.pictures import drawn

    test = os.environ.get("PYTEST_CURRENT_TEST", "frame").rpartition(" (")[0] or "frame"
    path = FAILURES / (re.sub(r"[^\w.-]+", "-", test).strip("-")[-120:] + ".png")
    path.parent.mkdir(exist_ok=True)
    shot = truth.shot
    path.write_bytes(png(shot.image))
    picture = drawn(shot.image, shot.lens, truth.truth.beacons, found)
    path.with_suffix(".drawn.png").write_bytes(png(picture))
    return path
