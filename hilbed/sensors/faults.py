"""What is wrong with a camera's detections: some are missed, all are noisy, some were never there."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

from hilbed.types import Rng
from hilbed.vision.lens import Lens
from hilbed.vision.seams import Detection

_USUAL_STD = 0.02  # pixels: a false detection looks like a true one


def misses(count: int, probability: float, rng: Rng) -> list[bool]:
    """Draws which of `count` detections are missed."""
    return (rng.random(count) < probability).tolist() if probability else [False] * count


def noisy(detection: Detection, std: float, rng: Rng) -> Detection:
    """Adds normal noise of `std` (rad) to a detection's azimuth and says so in its std."""
    if not std:
        return detection
    azimuth = detection.azimuth + std * rng.standard_normal()
    return detection._replace(azimuth=azimuth, std=hypot(detection.std, std))


def spurious(mean: float, lens: Lens, names: Sequence[int | None], rng: Rng) -> list[Detection]:
    """Draws false detections, Poisson in number, uniform over the field of view, claiming any of `names`."""
    if not mean:
        return []
    found = []
    for azimuth in rng.uniform(-0.5 * lens.fov, 0.5 * lens.fov, rng.poisson(mean)).tolist():
        claim = names[int(rng.integers(len(names)))] if names else None
        found.append(Detection(azimuth, _USUAL_STD / lens.fx, lens.column(azimuth), claim))
    return found
