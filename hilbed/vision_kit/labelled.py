"""What everything here works on: a shot with its truth."""

from __future__ import annotations

from typing import NamedTuple

from hilbed.vision.seams import Shot, ShotTruth


class LabelledShot(NamedTuple):
    """What a detector gets, and what it should have found."""

    shot: Shot
    truth: ShotTruth
