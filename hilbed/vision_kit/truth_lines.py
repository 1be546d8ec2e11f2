"""The truth of a frame as one JSON line, and back without loss."""

from __future__ import annotations

import json
from math import isfinite, nan
from typing import Any

from hilbed.types import Pose
from hilbed.vision.seams import BeaconTruth, ShotTruth, Viewpoint


def to_line(k: int, file: str, truth: ShotTruth) -> str:
    """Returns the line of frame k, whose image lies in `file`; what is not a number is null."""
    entry = {
        "frame": k,
        "file": file,
        "t": truth.t,
        "view": truth.view._asdict(),
        "body": truth.body._asdict(),
        "beacons": [_finite(beacon._asdict()) for beacon in truth.beacons],
    }
    return json.dumps(entry, allow_nan=False) + "\n"


def _finite(values: dict[str, Any]) -> dict[str, Any]:
    return {
        key: None if isinstance(value, float) and not isfinite(value) else value
        for key, value in values.items()
    }


def from_line(line: str) -> tuple[str, ShotTruth]:
    """Returns the image's file and the truth; raises ValueError where the line is not one of a dataset."""
    try:
        entry = json.loads(line)
        beacons = tuple(_beacon(one) for one in entry["beacons"])
        truth = ShotTruth(int(entry["t"]), Viewpoint(**entry["view"]), Pose(**entry["body"]), beacons)
        return str(entry["file"]), truth
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise ValueError(f"no truth of a frame: {error!r}") from None


def _beacon(entry: dict[str, Any]) -> BeaconTruth:
    box = entry.pop("box")
    numbers: dict[str, Any] = {key: nan if value is None else value for key, value in entry.items()}
    return BeaconTruth(**numbers, box=None if box is None else tuple(box))
