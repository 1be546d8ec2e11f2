"""The boxes of a dataset in the format of COCO, one category a beacon."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

from hilbed.scene import BeaconSpec
from hilbed.vision.lens import Lens
from hilbed.vision.seams import BeaconTruth, ShotTruth


def coco(
    frames: Callable[[], Iterable[tuple[str, ShotTruth]]], beacons: Sequence[BeaconSpec], lens: Lens
) -> Iterator[str]:
    """Yields the annotations of frames, each a file name and its truth, as JSON, in pieces.

    Identifiers count from 1, so category k + 1 is the beacon of index k; a box is x, y, width, height in
    pixels from the image's upper left corner. Besides COCO's keys: azimuth (rad), distance (m), visible.
    frames: gives them anew at each call, so that never all of them are held.
    """
    categories = [
        {"id": k + 1, "name": f"{k} {beacon.colour}", "supercategory": "beacon"}
        for k, beacon in enumerate(beacons)
    ]
    yield '{"categories": ' + json.dumps(categories)
    yield from _listed("images", _images(frames(), lens))
    yield from _listed("annotations", _annotations(frames()))
    yield "}\n"


def _listed(name: str, entries: Iterable[dict[str, Any]]) -> Iterator[str]:
    """Yields a list, one entry a line."""
    yield f',\n"{name}": ['
    for k, entry in enumerate(entries):
        yield (",\n" if k else "\n") + json.dumps(entry, allow_nan=False)
    yield "\n]"


def _images(frames: Iterable[tuple[str, ShotTruth]], lens: Lens) -> Iterator[dict[str, Any]]:
    for number, (file, _) in enumerate(frames, 1):
        yield {"id": number, "file_name": file, "width": lens.width, "height": lens.height}


def _annotations(frames: Iterable[tuple[str, ShotTruth]]) -> Iterator[dict[str, Any]]:
    count = 0
    for number, (_, truth) in enumerate(frames, 1):
        for beacon in truth.beacons:
            if beacon.box is not None:
                count += 1
                yield _annotation((count, number), beacon, beacon.box)


def _annotation(ids: tuple[int, int], beacon: BeaconTruth, box: tuple[int, int, int, int]) -> dict[str, Any]:
    left, top, right, bottom = box
    width, height = right - left + 1, bottom - top + 1
    return {
        "id": ids[0],
        "image_id": ids[1],
        "category_id": beacon.beacon + 1,
        "bbox": [left, top, width, height],
        "area": width * height,
        "iscrowd": 0,
        "azimuth": beacon.azimuth,
        "distance": beacon.distance,
        "visible": beacon.visible,
    }
