"""Scenario block of all that a camera sees besides beacons: `plant.scenery`."""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from hilbed.scene.colours import AnyColour
from hilbed.spec import Finite, Fraction, NonNegative, Point, Positive, Spec

Pattern = Literal["plain", "checker", "noise", "carpet", "wood", "bricks"]
Corner = tuple[float, float]
Rectangle = tuple[Corner, Corner]
Count = Annotated[int, Field(ge=0, le=100)]


class SurfaceSpec(Spec):
    """What covers a plane: a pattern of two colours that repeats every `tile` m."""

    pattern: Pattern = "plain"
    colour: AnyColour = (0.6, 0.6, 0.6)
    second: AnyColour = (0.5, 0.5, 0.5)
    tile: Annotated[Positive, Field(ge=0.05, le=100)] = 2.0


class FloorSpec(SurfaceSpec):
    """The ground, as far as the walls or to the horizon."""


class WallsSpec(SurfaceSpec):
    """Four walls around the arena.

    height m; corner, opposite: m in the map, none: `margin` m outside the outermost beacons.
    """

    colour: AnyColour = (0.82, 0.8, 0.76)
    second: AnyColour = (0.7, 0.66, 0.6)
    height: Positive = 1.0
    corner: Point | None = None
    opposite: Point | None = None
    margin: Positive = 1.0

    @model_validator(mode="after")
    def _corners(self) -> Self:
        if (self.corner is None) != (self.opposite is None):
            raise ValueError("walls need both corner and opposite, or neither")
        if (
            self.corner
            and self.opposite
            and any(a >= b for a, b in zip(self.corner, self.opposite, strict=True))
        ):
            raise ValueError(f"opposite {self.opposite} must lie beyond corner {self.corner} in x and y")
        return self

    def room(self, beacons: Sequence[Corner]) -> Rectangle:
        """Returns the corners (m, map) of least and of largest x and y between the walls."""
        if self.corner and self.opposite:
            return self.corner, self.opposite
        xs, ys = [x for x, _ in beacons] or [0.0], [y for _, y in beacons] or [0.0]
        margin = self.margin
        return (min(xs) - margin, min(ys) - margin), (max(xs) + margin, max(ys) + margin)


class ObjectSpec(Spec):
    """Something that is no beacon: furniture, a distractor of a beacon's colour, somebody who walks by.

    at: m in the map; yaw rad; width, depth (m, none: as the width), height m, foot at `lift` m. With a path
    (m in the map) it moves along it at `speed` m/s from the start of the run on, around and around if closed,
    else back and forth; then `at` is of no meaning and need not be given.
    """

    shape: Literal["cone", "cylinder", "sphere", "box"] = "box"
    at: Point = (0.0, 0.0)
    yaw: Finite = 0.0
    width: Positive = 0.5
    depth: Positive | None = None
    height: Positive = 0.5
    lift: NonNegative = 0.0
    colour: AnyColour = (0.45, 0.4, 0.35)
    path: list[Point] = []
    speed: NonNegative = 0.5
    closed: bool = False

    @model_validator(mode="after")
    def _moves(self) -> Self:
        if len(self.path) == 1:
            raise ValueError("a path needs two points or more")
        if any(a == b for a, b in zip(self.path, self.path[1:], strict=False)):
            raise ValueError("two points of the path in a row are the same")
        return self


class LightSpec(Spec):
    """How bright it is, and what blinds the camera.

    level: of all that is seen, 0 dark, 1 as usual, above it white burns out; directed: part of the light that
    comes from azimuth and elevation (rad, map), the rest from everywhere; veil: part of white that glare
    lays over the whole frame; sun: brightness of the spot that stands where the light comes from, with its
    halo, none for 0; size: rad, half the width of that spot.
    """

    level: Annotated[NonNegative, Field(le=10)] = 1.0
    directed: Fraction = 0.0
    azimuth: Finite = 0.0
    elevation: Annotated[float, Field(ge=0, le=pi / 2)] = 0.6
    veil: Fraction = 0.0
    sun: Fraction = 0.0
    size: Annotated[Positive, Field(le=1)] = 0.05


class RandomSpec(Spec):
    """Scenery made up from a seed, in addition to what is stated.

    seed: none for that of the scenario; boxes: furniture beyond the beacons; distractors: things of nearly a
    beacon's colour; passers: columns that walk among the beacons; surfaces, light: of these, too.
    """

    seed: Annotated[int, Field(ge=0, lt=2**63)] | None = None
    boxes: Count = 6
    distractors: Count = 4
    passers: Count = 2
    surfaces: bool = True
    light: bool = True


def _preset(value: Any) -> Any:
    if not isinstance(value, str):
        return value
    if value not in PRESETS:
        raise ValueError(f"{value!r} is none of {', '.join(PRESETS)}; or give a block with floor, walls, …")
    return PRESETS[value]


class ScenerySpec(Spec):
    """What stands around the beacons; nothing of it by default, on white.

    sky: colour behind everything; objects: they hide what is behind them, but nobody runs into them.
    """

    sky: AnyColour = (1.0, 1.0, 1.0)
    floor: FloorSpec | None = None
    walls: WallsSpec | None = None
    objects: Annotated[list[ObjectSpec], Field(max_length=200)] = []
    light: LightSpec = LightSpec()
    random: RandomSpec | None = None


PRESETS: dict[str, dict[str, Any]] = {
    "void": {},
    "arena": {
        "sky": (0.86, 0.9, 0.95),
        "floor": {"colour": (0.55, 0.55, 0.53)},
        "walls": {"height": 0.8},
    },
    "hall": {
        "sky": (0.8, 0.82, 0.84),
        "floor": {"pattern": "wood", "colour": (0.62, 0.52, 0.42), "second": (0.5, 0.41, 0.33)},
        "walls": {"pattern": "bricks", "height": 1.2},
    },
    "random": {"random": {}},
}
"""Scenery by a word."""


SceneryBlock = Annotated[ScenerySpec, BeforeValidator(_preset)]
"""`arena` or a block."""
