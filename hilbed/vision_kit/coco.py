"""The boxes of a dataset in the format of COCO, one category a beacon."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from typing import Any

from hilbed.scene import BeaconSpec
from hilbed.vision.lens import Lens
from hilbed.vision.seams import BeaconTruth, ShotTruth


def coco(frames: Iterable[tuple[str, ShotTruth]], beacons: Sequence[BeaconSpec], lens: Lens) -> str:
    """Returns the annotations of frames, each a file name and its truth, as JSON.

    Identifiers count from 1, so category k + 1 is the beacon of index k; a box is x, y, width, height in
    pixels from the image's upper left corner. Besides COCO's keys: azimuth (rad), distance (m), visible.
    """
    images: list[dict[str, Any]] = []
    annotations: list[dict[str, Any]] = []
    for number, (file, truth) in enumerate(frames, 1):
        images.append({"id": number, "file_name": file, "width": lens.width, "height": lens.height})
        for beacon in truth.beacons:
            if beacon.box is not None:
                annotations.append(_annotation(len(annotations) + 1, number, beacon, beacon.box))
    categories = [
        {"id": k + 1, "name": f"{k} {beacon.colour}", "supercategory": "beacon"}
        for k, beacon in enumerate(beacons)
    ]
    content = {"images": images, "annotations": annotations, "categories": categories}
    return json.dumps(content, indent=1, allow_nan=False) + "\n"


def _annotation(
    number: int, image: int, beacon: BeaconTruth, box: tuple[int, int, int, int]
) -> dict[str, Any]:
    left, top, right, bottom = box
    width, height = right - left + 1, bottom - top + 1
    return {
        "id": number,
        "image_id": image,
        "category_id": beacon.beacon + 1,
        "bbox": [left, top, width, height],
        "area": width * height,
        "iscrowd": 0,
        "azimuth": beacon.azimuth,
        "distance": beacon.distance,
        "visible": beacon.visible,
    }
