"""Beacons: what a camera is to find, by place, shape, colour or marker."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from hilbed.clock import SECOND
from hilbed.scene.colours import BeaconColour
from hilbed.spec import Finite, Fraction, Point, Positive, Spec
from hilbed.types import Nanos

DICTIONARIES = {
    "4X4_50": 50, "5X5_50": 50, "6X6_50": 50,
    "APRILTAG_16h5": 30, "APRILTAG_25h9": 35, "APRILTAG_36h11": 587,
}  # fmt: skip
"""Markers' dictionaries, with the number of markers that each has."""
MOST_BEACONS = 255
"""That can be told apart in a frame's labels."""

MARKED = ("board", "box", "cylinder")


class FlashSpec(Spec):
    """A lamp that goes on and off in simulated time.

    period s; duty: part of it that the lamp is on; phase: part of a period by which it is ahead.
    """

    period: Annotated[Positive, Field(ge=0.001)] = 1.0
    duty: Fraction = 0.5
    phase: Fraction = 0.0

    def lit(self, t: Nanos) -> bool:
        """Returns whether the lamp is on at t."""
        period = round(self.period * SECOND)
        return (t + round(self.phase * period)) % period < self.duty * period


class BeaconSpec(Spec):
    """A beacon on the ground.

    at: m in the map; shape: a truncated cone (its edges cross pixel columns, so its azimuth is sub-pixel), a
    cylinder, a sphere whose top is at `height`, a board or a box; radii (m) at the foot, that is half the
    width of what is no cone, and at a cone's top; height m. Colours lie 30° apart in hue. marker: its number,
    on the square below the upper edge of a board, on each side of a box (then a cube) and three times around
    a cylinder; dictionary: the marker's, by its name in OpenCV; facing: rad, where board, box or marker
    look, none: always towards the camera; flash: none for a beacon that is always lit.
    """

    at: Point
    shape: Literal["cone", "cylinder", "sphere", "board", "box"] = "cone"
    colour: BeaconColour = "red"
    foot_radius: Positive = 0.07
    top_radius: Positive = 0.03
    height: Positive = 0.5
    marker: Annotated[int, Field(ge=0)] | None = None
    dictionary: Literal[
        "4X4_50", "5X5_50", "6X6_50", "APRILTAG_16h5", "APRILTAG_25h9", "APRILTAG_36h11",
    ] = "4X4_50"  # fmt: skip
    facing: Finite | None = None
    flash: FlashSpec | None = None

    @model_validator(mode="after")
    def _marker_fits(self) -> Self:
        if self.marker is not None and self.shape not in MARKED:
            raise ValueError(f"a {self.shape} carries no marker; {', '.join(MARKED)} do")
        last = DICTIONARIES[self.dictionary] - 1
        if self.marker is not None and self.marker > last:
            raise ValueError(f"dictionary {self.dictionary} has the markers 0…{last}, not {self.marker}")
        low = self.shape == "sphere" or self.marker is not None
        if low and self.height < 2.0 * self.foot_radius:
            raise ValueError(f"height {self.height:g} is less than the width of the {self.shape}")
        return self

    def lit(self, t: Nanos) -> bool:
        """Returns whether it can be seen for what it is at t."""
        return self.flash is None or self.flash.lit(t)

    @property
    def upper_radius(self) -> float:
        """Half the width at the top (m); a sphere's is that of its middle."""
        return self.top_radius if self.shape == "cone" else self.foot_radius
