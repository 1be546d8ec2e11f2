"""Shows frames to a detector, one by one, and keeps what came of it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from heapq import nlargest
from time import perf_counter
from typing import NamedTuple

from hilbed.types import Image
from hilbed.vision.seams import Detection, DetectionFailed, Detector, quoted
from hilbed.vision_kit.labelled import LabelledShot
from hilbed.vision_kit.matching import Matched, Sighting, Stray, match

WORST = 8
"""Frames that are kept as pictures."""


class Rules(NamedTuple):
    """Which beacons have to be found: the part (0…1) that is seen, the distance (m, from and to)."""

    visible: float
    distance: tuple[float, float]

    def due(self, one: Sighting) -> bool:
        """Tells whether a beacon has to be found."""
        return not one.cut and self.sees(one) and self.reaches(one)

    def sees(self, one: Sighting) -> bool:
        """Tells whether enough of a beacon is seen."""
        return one.visible >= self.visible

    def reaches(self, one: Sighting) -> bool:
        """Tells whether a beacon is at a distance at which it has to be found."""
        near, far = self.distance
        return near <= one.distance <= far


class Picture(NamedTuple):
    """A frame to be shown: its number, what it shows, what was found and how bad that is."""

    frame: int
    labelled: LabelledShot
    found: tuple[Detection, ...]
    matched: Matched
    badness: float


class Trial(NamedTuple):
    """What a detector made of frames; seconds: of each; failed: why it gave no answer, by frame."""

    rules: Rules
    sightings: list[Sighting]
    strays: list[Stray]
    seconds: list[float]
    failed: dict[int, str]
    worst: list[Picture]

    @property
    def frames(self) -> int:
        return len(self.seconds)


def run_trial(
    shots: Iterable[LabelledShot],
    detector: Detector,
    rules: Rules,
    tell: Callable[[int], None],
    first: int = 0,
) -> Trial:
    """Returns what a detector makes of shots.

    tell: is called with the number of each frame; first: number of the first one.
    """
    trial = Trial(rules, [], [], [], {}, [])
    for k, labelled in enumerate(shots, first):
        tell(k)
        start = perf_counter()
        try:
            found = tuple(detector.detect(labelled.shot))
        except DetectionFailed as failure:
            trial.failed[k] = f"{failure.failure}: {failure}{quoted(failure.trouble.said)}"
            found = ()
        trial.seconds.append(perf_counter() - start)
        picture = _judge(k, labelled, found, rules)
        trial.sightings.extend(picture.matched.sightings)
        trial.strays.extend(picture.matched.strays)
        trial.worst[:] = nlargest(WORST, [*trial.worst, picture], key=lambda one: one.badness)
    return trial


def joined(parts: Sequence[Trial]) -> Trial:
    """Returns trials whose frames are numbered on as one; there has to be one at least."""
    whole = Trial(parts[0].rules, [], [], [], {}, [])
    for part in parts:
        whole.sightings.extend(part.sightings)
        whole.strays.extend(part.strays)
        whole.seconds.extend(part.seconds)
        whole.failed.update(part.failed)
    pictures = [picture for part in parts for picture in part.worst]
    return whole._replace(worst=nlargest(WORST, pictures, key=lambda one: one.badness))


def _judge(k: int, labelled: LabelledShot, found: tuple[Detection, ...], rules: Rules) -> Picture:
    frame = (k, light(labelled.shot.image))
    matched = match(frame, labelled.truth.beacons, found, labelled.shot.lens)
    return Picture(k, labelled, found, matched, badness(matched, rules))


def light(image: Image) -> float:
    """Returns the mean brightness of an image, 0…1."""
    return float(image.mean()) / 255.0


def badness(matched: Matched, rules: Rules) -> float:
    """Returns how much is wrong with a frame: mistakes count more than misses, those more than errors."""
    wrong = 1e4 * sum(one.mistaken for one in matched.sightings) + 1e3 * len(matched.strays)
    missed = 1e2 * sum(rules.due(one) and not one.found for one in matched.sightings)
    largest = max((abs(one.error_px) for one in matched.sightings if one.found), default=0.0)
    return wrong + missed + largest
