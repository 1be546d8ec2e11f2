from __future__ import annotations

from itertools import pairwise
from math import cos, hypot, inf, pi, sin, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import TypeAdapter, ValidationError

from hilbed.angles import wrap
from hilbed.control.reference import (
    CircleSpec,
    FigureEightSpec,
    LineSpec,
    PathReference,
    StadiumSpec,
    WaypointsSpec,
)
from hilbed.control.timetable import Timetable

PATHS = {
    "line": {"kind": "line", "start": (1, 2, 0.7), "length": 5.0},
    "circle": {"kind": "circle", "centre": (1, -1), "radius": 2.0},
    "clockwise": {"kind": "circle", "radius": 1.5, "clockwise": True},
    "stadium": {"kind": "stadium", "centre": (0.5, 0.5), "straight": 3.0, "radius": 1.0, "yaw": 0.4},
    "eight": {"kind": "figure_eight", "radius": 1.2, "yaw": -0.3},
    "waypoints": {"kind": "waypoints", "points": [(0, 0), (3, 0), (3, 2), (5, 3)]},
    "loop": {"kind": "waypoints", "points": [(0, 0), (3, 0), (3, 2), (-1, 3)], "closed": True},
}
CLOSED = ["circle", "clockwise", "stadium", "eight", "loop"]
PathSpec = LineSpec | CircleSpec | StadiumSpec | FigureEightSpec | WaypointsSpec
SPEC: TypeAdapter[PathSpec] = TypeAdapter(PathSpec)


def build(name: str, **changes: object) -> PathReference:
    return SPEC.validate_python({**PATHS[name], **changes}).build()


def length(name: str) -> float:
    return SPEC.validate_python(PATHS[name]).path().length


@pytest.mark.parametrize("name", PATHS)
@pytest.mark.parametrize("acceleration", [None, 0.4])
@settings(max_examples=30, deadline=None)
@given(moment=st.integers(0, 40_000_000_000))
def test_speeds_are_the_derivative_of_the_pose(name: str, acceleration: float | None, moment: int) -> None:
    reference, h = build(name, acceleration=acceleration), 1000
    (before, v0, w0), (pose, v, w), (after, v1, w1) = (reference.at(moment + k * h) for k in (0, 1, 2))
    if w0 != pytest.approx(w1, abs=1e-3) or v0 != pytest.approx(v1, abs=1e-3):
        return  # a joint, or the end: the derivative jumps
    dt = 2 * h * 1e-9
    assert (after.x - before.x) / dt == pytest.approx(v * cos(pose.yaw), abs=1e-5)
    assert (after.y - before.y) / dt == pytest.approx(v * sin(pose.yaw), abs=1e-5)
    assert wrap(after.yaw - before.yaw) / dt == pytest.approx(w, abs=1e-5)


@pytest.mark.parametrize("name", PATHS)
def test_the_path_has_no_gaps(name: str) -> None:
    reference = build(name)
    step = 10_000_000
    poses = [reference.at(k * step).pose for k in range(4000)]
    jumps = [hypot(b.x - a.x, b.y - a.y) for a, b in pairwise(poses)]
    turns = [abs(wrap(b.yaw - a.yaw)) for a, b in pairwise(poses)]
    assert max(jumps) < 0.0051
    assert max(turns) < 0.5 * 0.01 / 0.3 + 1e-6


@pytest.mark.parametrize("name", CLOSED)
def test_closed_paths_close_and_repeat(name: str) -> None:
    path = SPEC.validate_python(PATHS[name]).path()
    start, _ = path.at(0.0)
    end, _ = path.at(np.nextafter(path.length, 0))
    assert (end.x, end.y) == pytest.approx((start.x, start.y), abs=1e-9)
    assert wrap(end.yaw - start.yaw) == pytest.approx(0, abs=1e-9)
    assert path.at(3.2 + 7 * path.length)[0] == pytest.approx(path.at(3.2)[0], abs=1e-9)


def test_lengths_are_those_of_geometry() -> None:
    assert length("circle") == pytest.approx(4 * pi)
    assert length("stadium") == pytest.approx(6 + 2 * pi)
    assert length("eight") == pytest.approx(4.8 * pi)
    cut = 0.6 - pi / 2 * 0.3
    assert SPEC.validate_python(
        {"kind": "waypoints", "points": [(0, 0), (3, 0), (3, 2)], "corner_radius": 0.3}
    ).path().length == pytest.approx(5 - cut)


def test_a_circle_stays_on_its_circle() -> None:
    reference = build("circle")
    for k in range(100):
        pose = reference.at(k * 123_456_789).pose
        assert hypot(pose.x - 1, pose.y + 1) == pytest.approx(2.0)
        assert wrap(pose.yaw) == pose.yaw


def test_joints_are_read_right_continuously() -> None:
    reference = build("stadium", straight=2.0, radius=1.0)  # at 0.5 m/s the straight ends at 4 s
    assert reference.at(4_000_000_000 - 1).w == 0.0
    assert reference.at(4_000_000_000).w == pytest.approx(0.5)
    eight = build("eight", radius=1 / pi)  # a loop takes 4 s
    assert [np.sign(eight.at(t).w) for t in (0, 4_000_000_000 - 1000, 4_000_000_000 + 1000)] == [1, 1, -1]


@pytest.mark.parametrize("name", PATHS)
def test_extent_is_the_box_of_the_path(name: str) -> None:
    path = SPEC.validate_python(PATHS[name]).path()
    points = np.array([path.at(s)[0][:2] for s in np.linspace(0, path.length, 20001)])
    box = path.extent()
    assert box == pytest.approx((*points.min(axis=0), *points.max(axis=0)), abs=1e-5)


def test_an_open_path_ends_standing_at_its_end() -> None:
    pose, v, w = build("line").at(11_000_000_000)
    assert pose == pytest.approx((1 + 5 * cos(0.7), 2 + 5 * sin(0.7), 0.7))
    assert (v, w) == (0.0, 0.0)


def test_the_start_ramp_needs_no_more_than_its_acceleration() -> None:
    reference = build("circle", acceleration=0.25, speed=0.5)
    speeds = [reference.at(k * 100_000_000).v for k in range(40)]
    assert speeds[0] == 0.0
    assert max(np.diff(speeds)) == pytest.approx(0.025)
    assert speeds[20:] == [0.5] * 20


@given(st.floats(0.1, 2), st.one_of(st.none(), st.floats(0.1, 5)), st.floats(0.05, 20))
def test_the_timetable_ends_where_the_path_does(speed: float, rate: float | None, way: float) -> None:
    table = Timetable(speed, rate, way)
    times = np.linspace(0, table.duration, 2001)
    rows = np.array([table.at(t) for t in times])
    travelled = np.trapezoid(rows[:, 1], times)
    assert travelled == pytest.approx(way, rel=2e-3)
    assert table.at(table.duration + 1) == (way, 0.0)
    assert np.all(np.diff(rows[:, 0]) >= -1e-9)
    assert rows[:, 1].max() <= speed + 1e-12
    if rate and way < speed**2 / rate:
        assert rows[:, 1].max() == pytest.approx(sqrt(rate * way), rel=1e-3)


@pytest.mark.parametrize(
    ("points", "words"),
    [
        ([(0, 0), (1, 0), (0, 0)], "turns back"),
        ([(0, 0), (0, 0), (1, 0)], "leg 1"),
        ([(0, 0), (1, 0), (1, 0.2), (0, 0.2)], "leg 2"),
    ],
)
def test_waypoints_that_cannot_be_rounded_say_which(points: list[tuple[float, float]], words: str) -> None:
    with pytest.raises(ValidationError, match=words):
        WaypointsSpec(kind="waypoints", points=tuple(points))


@pytest.mark.parametrize(
    "bad",
    [
        {"kind": "circle", "radius": 0},
        {"kind": "line", "length": inf},
        {"kind": "stadium", "speed": -0.5},
        {"kind": "spiral"},
        {"kind": "waypoints", "points": [(0, 0)]},
    ],
)
def test_bad_settings_are_refused(bad: dict[str, object]) -> None:
    with pytest.raises(ValidationError):
        SPEC.validate_python(bad)
