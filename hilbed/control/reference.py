"""Reference paths: line, circle, stadium, figure eight and rounded waypoints, driven by a timetable."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import atan2, cos, hypot, inf, pi, sin, tan, tau
from typing import Annotated, Literal

from pydantic import Field, model_validator

from hilbed.angles import wrap
from hilbed.control.arcs import Arc, Box, Path
from hilbed.control.timetable import Timetable
from hilbed.spec import Finite, Listed, Point, Positive, Spec
from hilbed.types import Nanos, Pose, ReferencePoint


class PathReference:
    """A path with a timetable: pose, speed and yaw rate over time, in closed form and right-continuous."""

    def __init__(self, path: Path, timetable: Timetable) -> None:
        self._path = path
        self._timetable = timetable

    def at(self, t: Nanos) -> ReferencePoint:
        """Returns the reference at `t`; at a joint of two arcs, the yaw rate of the next."""
        length, v = self._timetable.at(t * 1e-9)
        pose, curvature = self._path.at(length)
        return ReferencePoint(pose, v, v * curvature)

    def extent(self) -> Box:
        """Returns the box (m) round the whole path."""
        return self._path.extent()


class _Reference(Spec):
    """speed m/s; acceleration (m/s²) of the ramps at start and open end, null for a jump."""

    speed: Annotated[float, Field(gt=0, le=100)] = 0.5
    acceleration: Positive | None = None

    def path(self) -> Path:
        """Returns the curve."""
        raise NotImplementedError

    def build(self) -> PathReference:
        """Returns the curve with its timetable."""
        path = self.path()
        length = inf if path.closed else path.length
        return PathReference(path, Timetable(self.speed, self.acceleration, length))


class LineSpec(_Reference):
    """A line from a start (m, m, yaw rad) over a length (m); then the reference stands."""

    kind: Literal["line"]
    start: Listed[tuple[Finite, Finite, Finite]] = (0.0, 0.0, 0.0)
    length: Positive = 10.0

    def path(self) -> Path:
        return Path(Pose(*self.start), [Arc(self.length)], closed=False)


class CircleSpec(_Reference):
    """A circle round a centre (m); from `angle` (rad, seen from the centre), to the left or clockwise."""

    kind: Literal["circle"]
    centre: Point = (0.0, 0.0)
    radius: Positive = 1.0
    angle: Finite = -pi / 2
    clockwise: bool = False

    def path(self) -> Path:
        sign = -1 if self.clockwise else 1
        x, y = self.centre[0] + self.radius * cos(self.angle), self.centre[1] + self.radius * sin(self.angle)
        start = Pose(x, y, wrap(self.angle + sign * pi / 2))
        return Path(start, [Arc(tau * self.radius, sign / self.radius)], closed=True)


class StadiumSpec(_Reference):
    """Two straights (m) joined by half circles (radius m), counter-clockwise round a centre (m).

    Starts at the beginning of the straight on the right of the centre, which runs at `yaw` (rad).
    """

    kind: Literal["stadium"]
    centre: Point = (0.0, 0.0)
    straight: Positive = 4.0
    radius: Positive = 1.5
    yaw: Finite = 0.0

    def path(self) -> Path:
        c, s = cos(self.yaw), sin(self.yaw)
        back, right = self.straight / 2, self.radius
        x, y = self.centre[0] - back * c + right * s, self.centre[1] - back * s - right * c
        half = [Arc(self.straight), Arc(pi * self.radius, 1 / self.radius)]
        return Path(Pose(x, y, wrap(self.yaw)), half * 2, closed=True)


class FigureEightSpec(_Reference):
    """Two circles (radius m) that touch at a centre (m): the left one first, from there, at `yaw` (rad)."""

    kind: Literal["figure_eight"]
    centre: Point = (0.0, 0.0)
    radius: Positive = 1.5
    yaw: Finite = 0.0

    def path(self) -> Path:
        loops = [Arc(tau * self.radius, sign / self.radius) for sign in (1, -1)]
        return Path(Pose(*self.centre, wrap(self.yaw)), loops, closed=True)


class WaypointsSpec(_Reference):
    """Straight legs between points (m) with corners rounded to a radius (m), driven at constant speed.

    An open path starts at the first point; a closed one, which turns at every point, in the middle of the
    first leg.
    """

    kind: Literal["waypoints"]
    points: Annotated[Listed[tuple[Point, ...]], Field(min_length=2)]
    corner_radius: Positive = 0.3
    closed: bool = False

    @model_validator(mode="after")
    def _corners_fit(self) -> WaypointsSpec:
        self.path()
        return self

    def path(self) -> Path:
        points = self.points
        if self.closed:
            middle = ((points[0][0] + points[1][0]) / 2, (points[0][1] + points[1][1]) / 2)
            points = (middle, *points[1:], points[0], middle)
        arcs = rounded(points, self.corner_radius)
        (x0, y0), (x1, y1) = points[:2]
        return Path(Pose(x0, y0, atan2(y1 - y0, x1 - x0)), arcs, self.closed)


def rounded(points: Sequence[Point], radius: float) -> list[Arc]:
    """Returns the legs between points (m) with corners of `radius` (m).

    A corner that turns by θ takes r tan(|θ|/2) off both its legs. Raises ValueError where points coincide,
    the path turns back on itself or a leg is too short for its corners.
    """
    steps = [(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(points)]
    headings = [atan2(dy, dx) for dx, dy in steps]
    turns = [wrap(b - a) for a, b in pairwise(headings)]
    if any(abs(turn) > pi - 1e-3 for turn in turns):
        raise ValueError("waypoints: the path turns back on itself; put a point aside of it")
    cuts = [0.0, *(radius * tan(abs(turn) / 2) for turn in turns), 0.0]
    arcs = []
    for i, (dx, dy) in enumerate(steps):
        left = hypot(dx, dy) - cuts[i] - cuts[i + 1]
        if hypot(dx, dy) == 0 or left < -1e-9:
            raise ValueError(
                f"waypoints: leg {i + 1} is {hypot(dx, dy):.3g} m long, its corners of radius {radius:g} m "
                f"take {cuts[i] + cuts[i + 1]:.3g} m; move the points apart or lower corner_radius"
            )
        arcs.append(Arc(max(left, 0.0)))
        if i < len(turns) and turns[i]:
            arcs.append(Arc(radius * abs(turns[i]), (1 if turns[i] > 0 else -1) / radius))
    return [arc for arc in arcs if arc.length > 0]
