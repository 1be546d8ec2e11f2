"""What stands in the arena: beacons, by place, shape and colour."""

from __future__ import annotations

from typing import Literal

from hilbed.spec import Point, Positive, Spec

Colour = tuple[float, float, float]

COLOURS: dict[str, Colour] = {
    "red": (1.0, 0.0, 0.0),
    "orange": (1.0, 0.5, 0.0),
    "yellow": (1.0, 1.0, 0.0),
    "lime": (0.5, 1.0, 0.0),
    "green": (0.0, 1.0, 0.0),
    "spring": (0.0, 1.0, 0.5),
    "cyan": (0.0, 1.0, 1.0),
    "azure": (0.0, 0.5, 1.0),
    "blue": (0.0, 0.0, 1.0),
    "violet": (0.5, 0.0, 1.0),
    "magenta": (1.0, 0.0, 1.0),
    "rose": (1.0, 0.0, 0.5),
}


class BeaconSpec(Spec):
    """A truncated cone on the ground: the edges of a cone cross pixel columns, so its azimuth is sub-pixel.

    at: m in the map; radii (m) at the foot and at the top; height m. Colours lie 30° apart in hue.
    """

    at: Point
    colour: Literal[
        "red", "orange", "yellow", "lime", "green", "spring",
        "cyan", "azure", "blue", "violet", "magenta", "rose",
    ] = "red"  # fmt: skip
    foot_radius: Positive = 0.07
    top_radius: Positive = 0.03
    height: Positive = 0.5
