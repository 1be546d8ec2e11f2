"""Scenery made up from a seed."""

from __future__ import annotations

from collections.abc import Sequence
from colorsys import hsv_to_rgb, rgb_to_hsv
from math import pi, tau

from hilbed import rng
from hilbed.scene.beacons import BeaconSpec
from hilbed.scene.colours import COLOURS, Colour
from hilbed.scene.scenery import (
    FloorSpec,
    LightSpec,
    ObjectSpec,
    RandomSpec,
    Rectangle,
    ScenerySpec,
    WallsSpec,
)
from hilbed.types import Rng

STREAM = "scenery"
_OFF_HUE = 14.0 / 360.0  # of a distractor: half way to the next beacon's


def seeded(spec: ScenerySpec, seed: int) -> ScenerySpec:
    """Returns the scenery of a scenario with `seed`."""
    if spec.random is None or spec.random.seed is not None:
        return spec
    return spec.model_copy(update={"random": spec.random.model_copy(update={"seed": seed})})


def made_up(spec: ScenerySpec, beacons: Sequence[BeaconSpec]) -> ScenerySpec:
    """Returns what a scenery with a random part comes to: the same for the same seed, all of it stated."""
    if spec.random is None:
        return spec
    wanted = spec.random
    chance = rng.stream(wanted.seed or 0, STREAM)
    objects = [*spec.objects, *_objects(wanted, spec.walls or WallsSpec(), beacons, chance)]
    update: dict[str, object] = {"random": None, "objects": objects}
    if wanted.surfaces:
        update |= _surfaces(spec, chance)
    if wanted.light:
        update["light"] = _light(chance)
    return spec.model_copy(update=update)


def _objects(
    wanted: RandomSpec, walls: WallsSpec, beacons: Sequence[BeaconSpec], chance: Rng
) -> list[ObjectSpec]:
    """Returns furniture and distractors near the walls, where they hide no beacon, and passers anywhere."""
    room, margin = walls.room([beacon.at for beacon in beacons]), walls.margin
    names: list[str] = [beacon.colour for beacon in beacons] or list(COLOURS)
    furniture = [_box(_by_the_wall(room, margin, chance), chance) for _ in range(wanted.boxes)]
    lures = [_lure(_by_the_wall(room, margin, chance), names, chance) for _ in range(wanted.distractors)]
    return furniture + lures + [_passer(room, chance) for _ in range(wanted.passers)]


def _by_the_wall(room: Rectangle, margin: float, chance: Rng) -> tuple[float, float]:
    """Returns a place (m) within 0.2 and 0.7 of the margin from one of the four walls."""
    (x0, y0), (x1, y1) = room
    depth, along, wall = margin * chance.uniform(0.2, 0.7), chance.uniform(0.05, 0.95), chance.integers(4)
    x, y = x0 + along * (x1 - x0), y0 + along * (y1 - y0)
    return ((x0 + depth, y), (x1 - depth, y), (x, y0 + depth), (x, y1 - depth))[wall]


def _box(at: tuple[float, float], chance: Rng) -> ObjectSpec:
    width, depth, height = chance.uniform((0.3, 0.2, 0.2), (0.9, 0.5, 1.0)).tolist()
    shade = float(chance.uniform(0.15, 0.7))
    colour = (shade, 0.95 * shade, 0.85 * shade)
    yaw = float(chance.uniform(-pi, pi))
    return ObjectSpec(at=at, yaw=yaw, width=width, depth=depth, height=height, colour=colour)


def _lure(at: tuple[float, float], names: Sequence[str], chance: Rng) -> ObjectSpec:
    """Returns something of nearly a beacon's colour."""
    hue, _, _ = rgb_to_hsv(*COLOURS[names[int(chance.integers(len(names)))]])
    hue += _OFF_HUE * float(chance.choice((-1.0, 1.0))) * float(chance.uniform(0.3, 1.0))
    colour: Colour = hsv_to_rgb(hue % 1.0, float(chance.uniform(0.6, 1.0)), float(chance.uniform(0.5, 1.0)))
    width, height = chance.uniform((0.08, 0.15), (0.4, 0.7)).tolist()
    shape = ("cone", "cylinder", "sphere", "box")[int(chance.integers(4))]
    return ObjectSpec.model_validate(
        {"at": at, "shape": shape, "width": width, "height": height, "colour": colour}
    )


def _passer(room: Rectangle, chance: Rng) -> ObjectSpec:
    """Returns a column as tall as a person that walks to and fro on a line across the room."""
    start, end = (tuple(chance.uniform(*room).tolist()) for _ in range(2))
    shade = float(chance.uniform(0.05, 0.5))
    width, height, speed = chance.uniform((0.35, 1.5, 0.4), (0.55, 1.9, 1.4)).tolist()
    return ObjectSpec(
        shape="cylinder", width=width, height=height, speed=speed, path=[start, end], colour=(shade,) * 3
    )


def _surfaces(spec: ScenerySpec, chance: Rng) -> dict[str, object]:
    """Returns sky, floor and walls; those that are stated stay."""
    patterns = ("plain", "checker", "noise", "carpet", "wood", "bricks")
    greys = chance.uniform(0.25, 0.85, 5).tolist()
    floor, walls = (patterns[k] for k in chance.integers(len(patterns), size=2))
    sky = (greys[0], greys[0], min(1.0, 1.1 * greys[0]))
    made = {"pattern": floor, "colour": (greys[1],) * 3, "second": (greys[2],) * 3}
    papered: dict[str, object] = {"pattern": walls, "colour": (greys[3],) * 3, "second": (greys[4],) * 3}
    papered |= {"height": float(chance.uniform(0.4, 2.0))}
    return {
        "sky": sky,
        "floor": spec.floor or FloorSpec.model_validate(made),
        "walls": spec.walls or WallsSpec.model_validate(papered),
    }


def _light(chance: Rng) -> LightSpec:
    """Returns any light from dusk to the sun in the camera; one scene in three has glare."""
    glare = bool(chance.random() < 1.0 / 3.0)
    return LightSpec(
        level=float(chance.uniform(0.25, 1.2)),
        directed=float(chance.uniform(0.0, 0.6)),
        azimuth=float(chance.uniform(0.0, tau)),
        elevation=float(chance.uniform(0.05, 1.2)),
        veil=float(chance.uniform(0.0, 0.3)) if glare else 0.0,
        sun=1.0 if glare else 0.0,
    )
