"""A reference of arcs, each driven in its own time: that of Bui & Duong (2022), section 3.1, by default."""

from __future__ import annotations

from bisect import bisect_right
from itertools import accumulate
from math import pi
from typing import Annotated, Literal

from pydantic import Field

from hilbed.clock import nanos
from hilbed.control.arcs import Arc, Box, Path
from hilbed.spec import Finite, Listed, Positive, Spec
from hilbed.types import Nanos, Pose, ReferencePoint


class LegSpec(Spec):
    """length m, curvature 1/m (positive to the left), duration s: driven at length / duration."""

    length: Positive
    curvature: Finite = 0.0
    duration: Positive


class LegsSpec(Spec):
    """Legs from a start (m, m, yaw rad); then the reference stands. Lines at 1 m/s, half circle at 4π/10."""

    kind: Literal["legs"] = "legs"
    start: Listed[tuple[Finite, Finite, Finite]] = (-20.0, 4.0, 0.0)
    legs: Annotated[Listed[tuple[LegSpec, ...]], Field(min_length=1)] = (
        LegSpec(length=20.0, duration=20.0),
        LegSpec(length=4.0 * pi, curvature=-0.25, duration=10.0),
        LegSpec(length=20.0, duration=20.0),
    )

    def build(self) -> Legs:
        """Returns the reference."""
        return Legs(self)


class Legs:
    """Pose, speed and yaw rate over time; at a joint those of the next leg, as they jump there."""

    def __init__(self, spec: LegsSpec) -> None:
        self._legs = spec.legs
        self._path = Path(Pose(*spec.start), (Arc(leg.length, leg.curvature) for leg in spec.legs), False)
        self._times = [0, *accumulate(nanos(leg.duration) for leg in spec.legs)]
        self._ways = [0.0, *accumulate(leg.length for leg in spec.legs)]

    def at(self, t: Nanos) -> ReferencePoint:
        """Returns the reference at `t`."""
        index = max(bisect_right(self._times, t) - 1, 0)
        if index == len(self._legs):
            return ReferencePoint(self._path.at(self._ways[-1])[0], 0.0, 0.0)
        leg = self._legs[index]
        v = leg.length / leg.duration
        pose, _ = self._path.at(self._ways[index] + v * (t - self._times[index]) * 1e-9)
        return ReferencePoint(pose, v, v * leg.curvature)

    def extent(self) -> Box:
        """Returns the box (m) round the whole path."""
        return self._path.extent()
