"""Checks of what stands around the beacons."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from hilbed.plant import PlantSpec, RecordedSpec
from hilbed.problems import Problem
from hilbed.scene import MOST_BEACONS, Corner
from hilbed.sensors import CameraSpec, SensorSpec

Problems = Iterator[Problem]


def inside(plant: PlantSpec) -> Problems:
    """What is outside the walls would be drawn in front of them."""
    if isinstance(plant, RecordedSpec) or plant.scenery.walls is None:
        return
    (x0, y0), (x1, y1) = plant.scenery.walls.room([beacon.at for beacon in plant.beacons])
    places: list[tuple[tuple[str | int, ...], Corner]] = [
        (("beacons", k, "at"), beacon.at) for k, beacon in enumerate(plant.beacons)
    ]
    for k, thing in enumerate(plant.scenery.objects):
        if thing.path:
            places += [(("scenery", "objects", k, "path"), at) for at in thing.path]
        else:
            places.append((("scenery", "objects", k, "at"), thing.at))
    walls = f"[{x0:g}, {y0:g}] … [{x1:g}, {y1:g}]"
    for path, (x, y) in places:
        if not (x0 < x < x1 and y0 < y < y1):
            key = ".".join(map(str, ("plant", *path)))
            yield Problem(("plant", *path), f"{key}: [{x:g}, {y:g}] is not between the walls, {walls}")


def few_enough(plant: PlantSpec, sensors: Mapping[str, SensorSpec]) -> Problems:
    """A camera's labels are bytes."""
    if isinstance(plant, RecordedSpec) or not any(isinstance(s, CameraSpec) for s in sensors.values()):
        return
    if len(plant.beacons) > MOST_BEACONS:
        text = f"plant.beacons: a camera tells at most {MOST_BEACONS} apart, not {len(plant.beacons)}"
        yield Problem(("plant", "beacons"), text)


CHECKS = (inside, few_enough)
